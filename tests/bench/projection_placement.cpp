#include "tests/bench/projection_placement.hpp"

#include <algorithm>
#include <cstdio>

#include "renderer/base/clock.hpp"
#include "renderer/film/exr.hpp"
#include "renderer/session/session.hpp"
#include "renderer/techniques/technique.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/gather_shared.h"

namespace limn::projection {
namespace {

Result<double> sampledShare(vk::Device& device, const Technique& technique, size_t pixels) {
  const auto texels = vk::readBackArray<shared::IndirectTexel>(device, *technique.indirect(), pixels);
  if (!texels) return texels.error();
  const auto sampled = std::count_if(texels->begin(), texels->end(), [](const shared::IndirectTexel& texel) {
    return texel.state == shared::kIndirectSampled;
  });
  return double(sampled) / double(pixels);
}

std::string captionOf(double seconds, double share) {
  char text[80];
  std::snprintf(text, sizeof text, "%.2f s: %.1f %% of pixels gathered", seconds, 100.0 * share);
  return text;
}

Result<PlacementReport> look(vk::Device& device, Session& session, double seconds, const std::string& file) {
  const auto frame = session.resolveFrame();
  if (!frame) return frame.error();
  const FrameInfo& info = (*frame)->info;
  const auto share = sampledShare(device, session.technique(), size_t(info.width) * info.height);
  if (!share) return share.error();
  const auto png = encodePng(info.width, info.height, (*frame)->rgba);
  if (!png) return png.error();
  return PlacementReport{seconds, info.steps, *share,
                         {file, captionOf(seconds, *share), std::string(png->begin(), png->end())}};
}

}  // namespace

Result<std::vector<PlacementReport>> reportPlacement(vk::Device& device, const LoadedScene& loaded,
                                                     const std::string& name, const ValidationOptions& options) {
  SessionConfig config;
  config.width = options.size.width;
  config.height = options.size.height;
  config.technique = "point-projection";
  Mailbox mailbox;
  FrameSlot frames;
  StatusQueue replies;
  auto session = Session::create(device, loaded.scene, loaded.report, config, mailbox, frames, replies);
  if (!session) return session.error();
  SetResolve view;
  view.view = ResolveView::placement;
  mailbox.push(EditRequest{{}, {Edit(view)}, nowSeconds()});
  if (auto done = (*session)->runSteps(0); !done) return done.error();
  std::vector<PlacementReport> reports;
  double seconds = 0.0;
  for (const double stamp : options.stamps) {
    const double begin = nowSeconds();
    if (auto done = (*session)->runSeconds(stamp - seconds); !done) return done.error();
    seconds += nowSeconds() - begin;
    const std::string file = name + "-placement-" + std::to_string(reports.size() + 1) + ".png";
    auto report = look(device, **session, seconds, file);
    if (!report) return report.error();
    reports.push_back(report.take());
  }
  return reports;
}

}  // namespace limn::projection
