#pragma once
#include <vector>

#include "server/arguments.hpp"

namespace limn {

/// One subcommand of `limn`. `run` prints to stdout; its Error becomes one line on stderr and the exit code.
struct Command {
  CommandSpec spec;
  Result<void> (*run)(const Arguments& arguments);
};

Command benchCommand();
Command compareCommand();
Command devicesCommand();
Command infoCommand();
Command mergeCommand();
Command renderCommand();
Command sendCommand();

/// Every subcommand, in the order of the help.
std::vector<Command> allCommands();

/// What main() does with the words after the program's name. Returns the exit code.
int runLimn(const std::vector<std::string>& words);

}  // namespace limn
