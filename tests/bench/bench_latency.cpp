// How long an edit takes to the picture: starts limnd on a scene, edits through a real socket, and waits for the first frame and
// for the first frame without unfilled pixels that show the edit. A benchmark: run it on an idle machine.
//   bench_latency [LIMND [SCENE.glb]]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "protocol/client/client.hpp"
#include "renderer/base/clock.hpp"
#include "tests/service/child_process.hpp"

namespace {

using namespace limn;
using namespace limn::protocol;

constexpr int kRepetitions = 40, kWarmUps = 5;

[[noreturn]] void fail(const std::string& text) {
  std::fprintf(stderr, "bench_latency: %s\n", text.c_str());
  std::exit(1);
}

template <class T>
T must(Result<T> result) {
  if (!result) fail(result.error().text());
  return result.take();
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, size_t(std::ceil(share * double(values.size()))) - 1)];
}

struct Latencies {
  std::vector<double> first, full;  ///< [ms]
};

/// One edit, and the times until its first frame and its first whole frame arrived.
void measureOnce(Client& client, const ClientMessage& edit, Latencies* into) {
  const double begin = nowSeconds();
  const uint32_t seq = client.send(edit);
  ReceivedFrame frame = must(client.frameShowing(seq, 60.0));
  const double first = frame.receivedAt;
  while (frame.header.gatheredShare < 1.0f) frame = must(client.frameShowing(seq, 60.0));
  if (!into) return;
  into->first.push_back((first - begin) * 1e3);
  into->full.push_back((frame.receivedAt - begin) * 1e3);
}

Latencies measure(Client& client, const char* name, const std::function<ClientMessage(int)>& edit) {
  Latencies all;
  for (int i = 0; i < kWarmUps; ++i) measureOnce(client, edit(i), nullptr);
  for (int i = 0; i < kRepetitions; ++i) measureOnce(client, edit(kWarmUps + i), &all);
  std::printf("%-10s first frame: median %6.1f ms, p95 %6.1f ms   whole frame: median %7.1f ms, p95 %7.1f ms\n", name,
              percentile(all.first, 0.5), percentile(all.first, 0.95), percentile(all.full, 0.5), percentile(all.full, 0.95));
  return all;
}

/// Processor ticks of a process: of all threads, and of those that render (the render thread and the driver's workers).
struct Ticks { double all = 0.0, renderer = 0.0; };

Ticks ticksOf(pid_t pid) {
  Ticks ticks;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task")) {
    std::ifstream file(task.path() / "stat");
    const std::string stat((std::istreambuf_iterator<char>(file)), {});
    const size_t open = stat.find('('), close = stat.rfind(')');
    if (open == stat.npos || close == stat.npos) continue;
    const std::string name = stat.substr(open + 1, close - open - 1);
    std::istringstream rest(stat.substr(close + 2));
    std::string skipped;
    for (int i = 0; i < 11; ++i) rest >> skipped;
    double user = 0.0, system = 0.0;
    rest >> user >> system;
    ticks.all += user + system;
    const bool renders = name.starts_with("limn-render") || name.starts_with("llvmpipe") || name.starts_with("lavapipe");
    if (renders) ticks.renderer += user + system;
  }
  return ticks;
}

View orbited(const View& view, double angle) {
  View moved = view;
  const double x = view.eye[0] - view.target[0], z = view.eye[2] - view.target[2];
  moved.eye[0] = view.target[0] + std::cos(angle) * x + std::sin(angle) * z;
  moved.eye[2] = view.target[2] - std::sin(angle) * x + std::cos(angle) * z;
  return moved;
}

ClientMessage set(Edit edit) {
  SetMessage message;
  message.edit = std::move(edit);
  return message;
}

/// Camera edits at 60 Hz for five seconds; says how the picture kept up.
void storm(Client& client, const View& view) {
  constexpr int kEdits = 300;
  std::vector<double> arrivals{nowSeconds()};
  const double begin = nowSeconds();
  for (int i = 0; i < kEdits; ++i) {
    SetCamera camera;
    camera.view = orbited(view, 0.003 * i);
    client.send(camera);
    const double next = begin + (i + 1) / 60.0;
    while (nowSeconds() < next)
      if (auto event = client.nextEvent(std::max(0.0, next - nowSeconds())); event && std::holds_alternative<ReceivedFrame>(*event))
        arrivals.push_back(std::get<ReceivedFrame>(*event).receivedAt);
  }
  double gap = 0.0;
  for (size_t i = 1; i < arrivals.size(); ++i) gap = std::max(gap, arrivals[i] - arrivals[i - 1]);
  std::printf("60 Hz camera storm: %.1f frames a second, largest gap %.0f ms\n",
              double(arrivals.size() - 1) / (nowSeconds() - begin), gap * 1e3);
}

uint32_t firstMovable(const SceneMessage& scene) {
  for (size_t i = scene.nodes.size(); i-- > 0;)
    if (scene.nodes[i].mesh && !scene.nodes[i].matrix) return uint32_t(i);
  fail("the scene has no object to move");
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path here = std::filesystem::canonical(argv[0]).parent_path();
  const std::string limnd = argc > 1 ? argv[1] : (here / "limnd").string();
  const std::string scenePath = argc > 2 ? argv[2] : (here.parent_path() / "scenes/demo.glb").string();
  server::testing::ChildProcess daemon(limnd, {"--scene", scenePath, "--listen", "127.0.0.1:0", "--size", "512x512"});
  std::string line = daemon.readLine();
  while (!line.empty() && line.find("http://") == line.npos) line = daemon.readLine();
  if (line.empty()) fail("limnd did not start");
  const std::string address = line.substr(line.find("http://") + 7);

  ClientOptions options;
  options.url = "ws://" + address;
  options.newestFrameOnly = true;
  auto client = must(Client::greet(options));
  const SceneMessage scene = must(client->request<SceneMessage>(Describe{}));
  if (scene.lights.empty() || scene.materials.empty()) fail("the scene has no punctual light or no material");
  const uint32_t node = firstMovable(scene);

  const Ticks before = ticksOf(daemon.pid());
  const Latencies camera = measure(*client, "camera", [&](int i) {
    SetCamera edit;
    edit.view = orbited(scene.view, 0.002 * (i + 1));
    return ClientMessage(edit);
  });
  const Latencies light = measure(*client, "light", [&](int i) {
    LightEdit edit;
    edit.intensity = scene.lights[0].intensity * (1.0f + 0.01f * float(i + 1));
    return set(edit);
  });
  const Latencies material = measure(*client, "material", [&](int i) {
    MaterialEdit edit;
    edit.baseColor = {0.01f * float(i + 1), 0.4f, 0.2f, 1.0f};
    return set(edit);
  });
  const Latencies transform = measure(*client, "transform", [&](int i) {
    NodeEdit edit;
    edit.node = node;
    edit.translation = scene.nodes[node].translation;
    (*edit.translation)[0] += 0.001 * (i + 1);
    return set(edit);
  });
  const Ticks after = ticksOf(daemon.pid());
  storm(*client, scene.view);

  const double all = after.all - before.all, outside = all - (after.renderer - before.renderer);
  std::printf("camera_first_p95_ms=%.1f camera_full_p95_ms=%.1f light_first_p95_ms=%.1f material_first_p95_ms=%.1f "
              "transform_first_p95_ms=%.1f outside=%.3f\n",
              percentile(camera.first, 0.95), percentile(camera.full, 0.95), percentile(light.first, 0.95),
              percentile(material.first, 0.95), percentile(transform.first, 0.95), all > 0.0 ? outside / all : 0.0);
  return 0;
}
