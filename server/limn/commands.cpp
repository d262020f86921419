#include "server/limn/commands.hpp"

#include <algorithm>
#include <cstdio>

#include "renderer/base/log.hpp"
#include "server/limn/interruption.hpp"

namespace limn {
namespace {

std::string overview() {
  std::string text = "usage: limn COMMAND [arguments]\n\ncommands:\n";
  for (const Command& command : allCommands()) {
    std::string line = "  " + command.spec.name.substr(std::string("limn ").size());
    line.resize(12, ' ');
    text += line + command.spec.summary + "\n";
  }
  return text + "\nlimn COMMAND --help lists the flags of a command.\n"
                "Exit codes: 0 done, 64 wrong usage, 75 the device must be reset, 130 or 143 interrupted, "
                "1 any other failure.\n";
}

/// The exit code of a command whose outcome is `done`. What it printed must have arrived, too.
int finish(const std::string& name, Result<void> done) {
  const bool printed = std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (done && !printed) done = Error{"io", "standard output cannot be written", ""};
  if (done) return kExitOk;
  const int code = reportFailure(name, done.error());
  return done.error().code == kInterrupted ? 128 + Interruption::signal() : code;
}

int print(const std::string& name, const std::string& text) {
  std::fputs(text.c_str(), stdout);
  return finish(name, {});
}

}  // namespace

std::vector<Command> allCommands() {
  return {renderCommand(), sendCommand(), compareCommand(), benchCommand(),
          mergeCommand(),  infoCommand(), devicesCommand()};
}

int runLimn(const std::vector<std::string>& words) {
  setLogLevel(LogLevel::warning);  // stderr is for what went wrong
  if (words.empty()) return reportFailure("limn", usageError("no command; limn --help lists them"));
  if (words[0] == "--help" || words[0] == "-h") return print("limn", overview());
  const std::vector<Command> commands = allCommands();
  const auto command = std::find_if(commands.begin(), commands.end(),
                                    [&](const Command& c) { return c.spec.name == "limn " + words[0]; });
  if (command == commands.end())
    return reportFailure("limn", usageError("unknown command '" + words[0] + "'; limn --help lists them"));

  const Result<Arguments> arguments = Arguments::parse(command->spec, std::span(words).subspan(1));
  if (!arguments) return reportFailure(command->spec.name, arguments.error());
  if (arguments->help()) return print(command->spec.name, helpText(command->spec));
  return finish(command->spec.name, command->run(*arguments));
}

}  // namespace limn
