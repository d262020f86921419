#include "renderer/scene/environment_image.hpp"
#include "renderer/scene/gltf_materials.hpp"

namespace limn::gltf {
namespace {

/// extras.limn.environment; extras may be anything, and are somebody else's where they are not of this shape.
std::optional<Value> environmentUri(const Value& root) {
  std::optional<Value> at(root);
  for (const char* const key : {"extras", "limn", "environment"}) {
    if (!at->has(key)) return std::nullopt;
    at = at->need(key);
  }
  return at;
}

}  // namespace

void readEnvironment(Document& document, Scene& scene) {
  const std::optional<Value> named = environmentUri(document.root());
  if (!named) return;
  const std::string& uri = named->asString();
  const std::string pointer = named->pointer();
  LoadReport& report = document.reporter.report();

  LoadLimits limits = document.limits;
  limits.maxImageBytes -= report.imageBytes;
  const std::vector<uint8_t> bytes = readUri(document.container, uri, limits.maxFileBytes, pointer);
  std::vector<std::string> notes;
  Result<Image> image = decodeEnvironmentImage(bytes, limits, notes);
  if (!image) fail(image.error().code, image.error().message, pointer);
  image->name = pathOfUri(document.container, uri, pointer);
  report.imageBytes += image->rgbaF.size() * sizeof(float);
  document.reporter.note("environment image: \"" + image->name + "\", " + std::to_string(image->width) + "x" +
                         std::to_string(image->height));
  for (const std::string& note : notes) document.reporter.note(note);
  scene.environment.radiance = glm::vec3(1.0f);
  scene.environment.image = std::make_shared<const Image>(image.take());
}

}  // namespace limn::gltf
