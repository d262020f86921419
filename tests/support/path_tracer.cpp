#include "tests/support/path_tracer.hpp"

#include <cmath>

#include "renderer/base/luminance.hpp"
#include "renderer/film/film_statistics.hpp"
#include "renderer/gpu/camera.hpp"
#include "renderer/gpu/pass.hpp"
#include "renderer/techniques/technique.hpp"
#include "renderer/vk/transfer.hpp"

namespace limn::test {
namespace {

void require(const Result<void>& done) { LIMN_CHECK(done.ok()); }
template <class T>
T require(Result<T> result) {
  LIMN_CHECK(result.ok());
  return result.take();
}

}  // namespace

struct PathTracer::Parts {
  explicit Parts(vk::Device& d)
      : device(d),
        film(require(Film::create(d, kSize, kSize))),
        statistics(require(FilmStatistics::create(d, film))),
        technique(makeTechnique("path-tracing")) {
    vk::BufferDesc desc;
    desc.size = sizeof(shared::CameraData);
    desc.name = "camera";
    desc.owner = "test";
    camera = require(vk::Buffer::create(d, desc));
    technique->setParameter("adaptive", 0.0);
  }

  vk::Device& device;
  Film film;
  FilmStatistics statistics;
  std::unique_ptr<Technique> technique;
  vk::Buffer camera;
};

PathTracer::PathTracer(vk::Device& device) : m_parts(std::make_unique<Parts>(device)) {}
PathTracer::~PathTracer() = default;

FilmImage PathTracer::render(const Scene& scene, const RenderOptions& options) {
  Parts& p = *m_parts;
  gpu::DeviceScene mirror(p.device);
  ChangeSet everything;
  everything.everything = true;
  LIMN_CHECK(mirror.sync(scene, everything).ok());
  std::vector<TriangleBlock> blocks;
  for (size_t i = 0; i < mirror.blocks().size(); ++i)
    blocks.push_back({mirror.blocks()[i].corners, mirror.blocks()[i].firstTriangle, mirror.blockNeedsAlpha(i)});
  SceneTracer tracer(options.method);
  require(tracer.update(p.device, blocks, {}));
  const shared::CameraData camera = gpu::cameraData(scene.view, mirror.renderOrigin(), kSize, kSize);
  require(vk::uploadArray(p.device, p.camera, std::span<const shared::CameraData>(&camera, 1)));

  const TechniqueContext context{.device = p.device,
                                 .description = scene,
                                 .scene = mirror,
                                 .tracer = tracer,
                                 .camera = p.camera,
                                 .film = p.film,
                                 .statistics = p.statistics,
                                 .seed = options.seed,
                                 .firstSample = 0,
                                 .lightingRevision = 0,
                                 .sampleLimit = options.samples};
  p.technique->setParameter("maxBounces", options.maxBounces);
  p.technique->setParameter("rouletteStart", options.rouletteStart);
  require(p.technique->prepare(context, sceneNeeds(scene), false));
  require(p.technique->restart(context, CostClass::reload));
  while (!require(p.technique->advance(context, 0.1)).converged) {
  }
  LIMN_CHECK(p.technique->discardedSamples() == 0);
  return require(p.film.read(p.device));
}

Measured measure(const FilmImage& image, const std::string& layer) {
  const FilmLayer *colors = image.find(layer), *errors = image.find("error");
  LIMN_CHECK(colors && errors && colors->channels == 3);
  Measured m;
  const size_t n = errors->data.size();
  for (size_t i = 0; i < n; ++i) {
    m.mean += luminance(&colors->data[3 * i]);
    m.error += double(errors->data[i]) * errors->data[i];
  }
  m.mean /= double(n);
  m.error = std::sqrt(m.error) / double(n);
  return m;
}

double zScore(const Measured& measured, double expected) {
  if (measured.mean == expected) return 0.0;
  return (measured.mean - expected) / std::sqrt(measured.error * measured.error + 1e-8 * expected * expected);
}

}  // namespace limn::test
