#include "renderer/scene/gltf_loader.hpp"

#include <algorithm>
#include <new>

#include "renderer/base/hash.hpp"
#include "renderer/scene/gltf_document.hpp"
#include "renderer/scene/gltf_materials.hpp"
#include "renderer/scene/gltf_nodes.hpp"
#include "renderer/scene/reach.hpp"
#include "renderer/scene/scene_estimate.hpp"
#include "renderer/scene/scene_needs.hpp"

namespace limn {
namespace {

void chooseView(Scene& scene, LoadReport& report) {
  for (uint32_t i = 0; i < scene.cameras.size(); ++i) {
    if (const std::optional<View> view = scene.viewOfCamera(i)) {
      scene.view = *view;
      return;
    }
  }
  scene.view = framingView(worldBounds(scene), Camera{});
  report.notes.push_back("no camera: one was added that frames the scene");
}

void ensureLight(Scene& scene, LoadReport& report) {
  const SceneNeeds needs = sceneNeeds(scene);
  if (needs.punctualLights || needs.emissiveTriangles || needs.environment) return;
  scene.environment.radiance = glm::vec3(1.0f);
  report.notes.push_back("no light: a neutral environment of radiance 1 was added");
}

void countGeometry(const Scene& scene, LoadReport& report) {
  report.triangles = report.vertices = report.imageBytes = 0;
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& primitive : mesh.primitives) {
      report.triangles += primitive.indices.size() / 3;
      report.vertices += primitive.positions.size();
    }
  }
  for (const Image& image : scene.images) report.imageBytes += image.rgba8.size() + image.rgbaF.size() * sizeof(float);
  if (scene.environment.image) report.imageBytes += scene.environment.image->rgbaF.size() * sizeof(float);
  if (report.triangles == 0) report.notes.push_back("the scene shows no triangle");
  if (report.degenerateTriangles > 0) {
    report.notes.push_back(std::to_string(report.degenerateTriangles) + " triangles without area were left out");
  }
}

/// Every node's triangles end in the hierarchy by themselves, so a few bytes of nodes can stand for any number of them.
void checkInstances(const Scene& scene, const LoadLimits& limits, LoadReport& report) {
  report.instancedTriangles = instancedTriangles(scene);
  if (report.instancedTriangles <= limits.maxTriangles) return;
  gltf::fail("limit",
             std::to_string(report.instancedTriangles) + " triangles over all nodes are more than the limit of " +
                 std::to_string(limits.maxTriangles),
             "/nodes");
}

void checkExtent(const Scene& scene) {
  if (!withinReach(worldBounds(scene)))
    gltf::fail("out-of-range", "the scene reaches farther than 1e15 from the origin", "/nodes");
}

LoadedScene load(const std::filesystem::path& file, const LoadOptions& options) {
  gltf::Document document{gltf::openContainer(file, options), options.limits, {}, {}, {}};
  const uint64_t contents = fnv1a(document.container.json);
  document.json = gltf::parseJson(document.container.json, options.limits.maxJsonDepth);
  document.container.json = {};
  gltf::checkStructure(document);
  gltf::parseModel(document);

  LoadedScene loaded;
  loaded.scene.name = file.filename().string();
  gltf::reportUnsupported(document);
  gltf::readMaterials(document, loaded.scene);
  gltf::readEnvironment(document, loaded.scene);
  gltf::readLights(document, loaded.scene);
  gltf::readCameras(document, loaded.scene);
  gltf::readNodes(document, loaded.scene);
  loaded.report = document.reporter.take();
  loaded.report.contents = contents;

  checkInstances(loaded.scene, options.limits, loaded.report);
  checkExtent(loaded.scene);
  countGeometry(loaded.scene, loaded.report);
  chooseView(loaded.scene, loaded.report);
  ensureLight(loaded.scene, loaded.report);
  return loaded;
}

}  // namespace

Result<LoadedScene> loadGltf(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string name = file.filename().string();
  try {
    return load(file, options);
  } catch (const gltf::Fault& fault) {
    return Error{fault.code, fault.message, fault.pointer.empty() ? name : name + "#" + fault.pointer};
  } catch (const std::bad_alloc&) { return Error{"limit", "the file needs more memory than there is", name}; }
}

}  // namespace limn
