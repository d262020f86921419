#include "renderer/scene/oiio_input.hpp"

#include <mutex>

namespace limn {

std::string oiioMessage(OIIO::ImageInput& input) {
  const std::string text = input.geterror();
  const std::string line = text.substr(0, text.find('\n'));
  return line.empty() ? "no reason given" : line;
}

Result<std::unique_ptr<OIIO::ImageInput>> openOiio(const char* reader, OIIO::Filesystem::IOProxy& memory) {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("try_all_readers", 0);
    OIIO::attribute("plugin_searchpath", "");
  });
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(reader);
  if (!input) return Error{"unsupported", std::string("there is no image reader \"") + reader + "\"", ""};
  if (!input->set_ioproxy(&memory))
    return Error{"unsupported", std::string(reader) + " cannot be read from memory", ""};
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::ImageSpec spec;
  if (!input->open(std::string("memory.") + reader, spec, config)) {
    return Error{"bad-file", "the image cannot be opened: " + oiioMessage(*input), ""};
  }
  return input;
}

}  // namespace limn
