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

}  // namespace

std::vector<Command> allCommands() {
  return {renderCommand(), sendCommand(), compareCommand(), benchCommand(),
          mergeCommand(),  infoCommand(), devicesCommand()};
}

int runLimn(const std::vector<std::string>& words) {
  setLogLevel(LogLevel::warning);  // stderr is for what went wrong
  if (words.empty()) return reportFailure("limn", usageError("no command; limn --help lists them"));
  if (words[0] == "--help" || words[0] == "-h") {
    std::fputs(overview().c_str(), stdout);
    return kExitOk;
  }
  const std::vector<Command> commands = allCommands();
  const auto command = std::find_if(commands.begin(), commands.end(),
                                    [&](const Command& c) { return c.spec.name == "limn " + words[0]; });
  if (command == commands.end())
    return reportFailure("limn", usageError("unknown command '" + words[0] + "'; limn --help lists them"));

  const Result<Arguments> arguments = Arguments::parse(command->spec, std::span(words).subspan(1));
  if (!arguments) return reportFailure(command->spec.name, arguments.error());
  if (arguments->help()) {
    std::fputs(helpText(command->spec).c_str(), stdout);
    return kExitOk;
  }
  const Result<void> done = command->run(*arguments);
  if (done) return kExitOk;
  const int code = reportFailure(command->spec.name, done.error());
  return done.error().code == kInterrupted ? 128 + Interruption::signal() : code;
}

}  // namespace limn
