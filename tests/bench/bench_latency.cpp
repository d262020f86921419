// How long an edit takes to the picture: starts limnd on a scene, edits through a real socket, and waits for the first
// frame and for the first frame without unfilled pixels that show the edit. With a technique, which is chosen over the
// socket, it looks at indirect light alone and also waits for the first frame that is not black. A benchmark: run it on
// an idle machine.
//   bench_latency [--technique NAME] [--repetitions N] [LIMND [SCENE.glb]]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "protocol/client/client.hpp"
#include "renderer/base/clock.hpp"
#include "tests/bench/picture_light.hpp"
#include "tests/service/child_process.hpp"

namespace {

using namespace limn;
using namespace limn::protocol;

constexpr int kWarmUps = 5;

struct Options {
  std::string limnd, scene, technique;  ///< technique: empty leaves the daemon's own, and the view as it is
  int repetitions = 40;
};

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
  std::vector<double> first, lit, full;  ///< [ms]
};

/// One edit, and the times until its first frame, its first that is not black, and its first whole one arrived.
void measureOnce(Client& client, const ClientMessage& edit, bool lookForLight, Latencies& into) {
  const double begin = nowSeconds();
  const uint32_t seq = client.send(edit);
  std::optional<double> first, lit;
  for (bool whole = false; !whole || (lookForLight && !lit);) {
    const ReceivedFrame frame = must(client.frameShowing(seq, 60.0));
    const double ms = (frame.receivedAt - begin) * 1e3;
    if (!first) first = ms;
    if (lookForLight && !lit && must(bench::holdsLight(frame.payload()))) lit = ms;
    if (!whole && frame.header.gatheredShare >= 1.0f) {
      whole = true;
      into.full.push_back(ms);
    }
  }
  into.first.push_back(*first);
  if (lit) into.lit.push_back(*lit);
}

void printTimes(const char* what, const std::vector<double>& times) {
  if (times.empty()) return;
  std::printf("   %s: median %7.1f ms, p95 %7.1f ms", what, percentile(times, 0.5), percentile(times, 0.95));
}

Latencies measure(Client& client, const Options& options, const char* name,
                  const std::function<ClientMessage(int)>& edit) {
  Latencies warmUp, all;
  const bool lookForLight = !options.technique.empty();
  for (int i = 0; i < kWarmUps; ++i) measureOnce(client, edit(i), lookForLight, warmUp);
  for (int i = 0; i < options.repetitions; ++i) measureOnce(client, edit(kWarmUps + i), lookForLight, all);
  std::printf("%-10s", name);
  printTimes("first frame", all.first);
  printTimes("first with indirect light", all.lit);
  printTimes("whole frame", all.full);
  std::printf("\n");
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
    const bool drivers = name.starts_with("llvmpipe") || name.starts_with("lavapipe");
    const bool renders = drivers || name.starts_with("limn-render");
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
    while (nowSeconds() < next) {
      const auto event = client.nextEvent(std::max(0.0, next - nowSeconds()));
      const auto* frame = event ? std::get_if<ReceivedFrame>(&*event) : nullptr;
      if (frame) arrivals.push_back(frame->receivedAt);
    }
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

/// Chooses the technique and shows what it adds to direct light; waits for the first picture of both.
void choose(Client& client, const std::string& technique) {
  TechniqueEdit chosen;
  chosen.technique = technique;
  const uint32_t seq = client.send(set(chosen));
  if (auto done = client.answer<Ack>(seq, 60.0); !done) fail(done.error().text());
  ResolveEdit shown;
  shown.view = ResolveView::indirect;
  must(client.frameShowing(client.send(set(shown)), 60.0));
}

struct Measured {
  Latencies camera, light, material, transform;
  double outside = 0.0;  ///< share of processor time that is not the renderer's
};

Measured measureEdits(Client& client, const SceneMessage& scene, const Options& options, pid_t daemon) {
  const uint32_t node = firstMovable(scene);
  const Ticks before = ticksOf(daemon);
  Measured m;
  m.camera = measure(client, options, "camera", [&](int i) {
    SetCamera edit;
    edit.view = orbited(scene.view, 0.002 * (i + 1));
    return ClientMessage(edit);
  });
  m.light = measure(client, options, "light", [&](int i) {
    LightEdit edit;
    edit.intensity = scene.lights[0].intensity * (1.0f + 0.01f * float(i + 1));
    return set(edit);
  });
  m.material = measure(client, options, "material", [&](int i) {
    MaterialEdit edit;
    edit.baseColor = {0.01f * float(i + 1), 0.4f, 0.2f, 1.0f};
    return set(edit);
  });
  m.transform = measure(client, options, "transform", [&](int i) {
    NodeEdit edit;
    edit.node = node;
    edit.translation = scene.nodes[node].translation;
    (*edit.translation)[0] += 0.001 * (i + 1);
    return set(edit);
  });
  const Ticks after = ticksOf(daemon);
  const double all = after.all - before.all, outside = all - (after.renderer - before.renderer);
  m.outside = all > 0.0 ? outside / all : 0.0;
  return m;
}

void printSummary(const Measured& m, const std::string& technique) {
  const auto p95 = [](const std::vector<double>& times) { return percentile(times, 0.95); };
  if (!technique.empty()) {
    std::printf("technique=%s light_first_p95_ms=%.1f light_indirect_p95_ms=%.1f material_first_p95_ms=%.1f "
                "material_indirect_p95_ms=%.1f transform_first_p95_ms=%.1f transform_indirect_p95_ms=%.1f\n",
                technique.c_str(), p95(m.light.first), p95(m.light.lit), p95(m.material.first), p95(m.material.lit),
                p95(m.transform.first), p95(m.transform.lit));
    return;
  }
  std::printf("camera_first_p95_ms=%.1f camera_full_p95_ms=%.1f light_first_p95_ms=%.1f material_first_p95_ms=%.1f "
              "transform_first_p95_ms=%.1f outside=%.3f\n",
              p95(m.camera.first), p95(m.camera.full), p95(m.light.first), p95(m.material.first),
              p95(m.transform.first), m.outside);
}

Options readOptions(int argc, char** argv) {
  const std::filesystem::path here = std::filesystem::canonical(argv[0]).parent_path();
  Options options{(here / "limnd").string(), (here.parent_path() / "scenes/demo.glb").string(), {}};
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.starts_with("--")) files.push_back(word);
    else if (i + 1 == argc) fail(word + " needs a value");
    else if (word == "--technique") options.technique = argv[++i];
    else if (word == "--repetitions") options.repetitions = std::max(1, std::atoi(argv[++i]));
    else fail("unknown argument " + word);
  }
  if (!files.empty()) options.limnd = files[0];
  if (files.size() > 1) options.scene = files[1];
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = readOptions(argc, argv);
  server::testing::ChildProcess daemon(
      options.limnd, {"--scene", options.scene, "--listen", "127.0.0.1:0", "--size", "512x512"});
  std::string line = daemon.readLine();
  while (!line.empty() && line.find("http://") == line.npos) line = daemon.readLine();
  if (line.empty()) fail("limnd did not start");
  const std::string address = line.substr(line.find("http://") + 7);

  ClientOptions clientOptions;
  clientOptions.url = "ws://" + address;
  clientOptions.newestFrameOnly = true;
  auto client = must(Client::greet(clientOptions));
  const SceneMessage scene = must(client->request<SceneMessage>(Describe{}));
  if (scene.lights.empty() || scene.materials.empty()) fail("the scene has no punctual light or no material");
  if (!options.technique.empty()) choose(*client, options.technique);

  const Measured measured = measureEdits(*client, scene, options, daemon.pid());
  storm(*client, scene.view);
  printSummary(measured, options.technique);
  return 0;
}
