#include <cstdio>

#include "server/limn/commands.hpp"
#include "server/limn/info_text.hpp"

namespace limn {
namespace {

Result<void> run(const Arguments& arguments) {
  const Result<LoadedScene> loaded = loadGltf(arguments.positionals()[0]);
  if (!loaded) return loaded.error();
  std::fputs(infoText(*loaded).c_str(), stdout);
  return {};
}

}  // namespace

Command infoCommand() {
  return {{"limn info", "Says what a glTF file holds, what of it is supported, and what it will cost.", {"SCENE"}, {}},
          run};
}

}  // namespace limn
