#include <cstdio>

#include "renderer/techniques/technique_info.hpp"
#include "server/limn/commands.hpp"
#include "server/limn/info_text.hpp"

namespace limn {
namespace {

Result<void> run(const Arguments& arguments) {
  const Result<PixelSize> size = parsePixelSize(arguments.text("size", "512x512"));
  if (!size) return size.error();
  SessionConfig config;
  config.width = size->width;
  config.height = size->height;
  config.technique = arguments.text("technique");
  if (!config.technique.empty() && !findTechnique(config.technique))
    return Error{"unsupported", "there is no technique '" + config.technique + "'", ""};
  const Result<LoadedScene> loaded = loadGltf(arguments.positionals()[0]);
  if (!loaded) return loaded.error();
  std::fputs(infoText(*loaded, config).c_str(), stdout);
  return {};
}

}  // namespace

Command infoCommand() {
  return {{"limn info",
           "Says what a glTF file holds, what of it is supported, and what it will cost.",
           {"SCENE"},
           {{"size", "WxH", "pixels of the picture whose memory is told (default: 512x512)"},
            {"technique", "T", "that makes it (default: the first that limnd announces)"}}},
          run};
}

}  // namespace limn
