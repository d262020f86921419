#include "tests/service/fake_renderer.hpp"

#include <limits>

#include "renderer/base/clock.hpp"
#include "renderer/base/hash.hpp"

namespace limn::server::testing {

FakeRenderer::FakeRenderer(const Options& options, Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies)
    : m_options(options), m_mailbox(mailbox), m_frames(frames), m_replies(replies), m_watched(options.watched) {
  m_scene.name = "fake.glb";
  m_scene.hash = 0x1234567890abcdefull;
  m_scene.sceneRevision = m_scene.viewRevision = 1;
  m_scene.materials.resize(options.materials);
  m_scene.nodes.resize(1);
  m_scene.lights.resize(1);
  m_scene.cameras.resize(1);
  m_scene.meshNames = {"box"};
  m_scene.technique = "fake";
  m_scene.parameters = {{"depth", 3.0}};
  m_scene.view = view();
  m_scene.width = options.width;
  m_scene.height = options.height;
  m_thread = std::thread([this] { run(); });
}

FakeRenderer::~FakeRenderer() {
  m_mailbox.close();
  m_thread.join();
}

View FakeRenderer::view() {
  View view;
  view.lens.yfov = 0.625f;
  return view;
}

std::vector<uint8_t> FakeRenderer::pixels(const Options& options, uint64_t frameId) {
  std::vector<uint8_t> rgba(size_t(options.width) * options.height * 4);
  uint64_t noise = frameId * 0x9e3779b97f4a7c15ull + 1;
  for (uint32_t y = 0, at = 0; y < options.height; ++y)
    for (uint32_t x = 0; x < options.width; ++x, at += 4) {
      noise = noise * 6364136223846793005ull + 1442695040888963407ull;
      rgba[at] = options.noisy ? uint8_t(noise >> 40) : uint8_t(x + frameId);
      rgba[at + 1] = options.noisy ? uint8_t(noise >> 48) : uint8_t(y * 2);
      rgba[at + 2] = options.noisy ? uint8_t(noise >> 56) : uint8_t(frameId * 37);
      rgba[at + 3] = 255;
    }
  return rgba;
}

void FakeRenderer::run() {
  std::vector<EditAck> superseded;
  while (!m_mailbox.closed()) {
    m_mailbox.waitFor(m_options.frameSeconds);
    if (m_held) {
      std::this_thread::yield();
      continue;
    }
    if (!m_busy)
      for (const Request& request : m_mailbox.drain(superseded)) handle(request);
    for (EditAck& ack : superseded) {
      ack.sceneRevision = m_scene.sceneRevision;
      ack.viewRevision = m_scene.viewRevision;
      m_replies.push(ack);
    }
    superseded.clear();
    if (m_watched && m_steps < m_options.passes) publish();
    answerWaits();
    Status status;
    status.phase = m_steps < m_options.passes ? Phase::converging : Phase::converged;
    status.idle = m_steps >= m_options.passes;
    status.steps = m_steps;
    status.device = "fake device";
    status.technique = "fake";
    status.stages = {{"trace", 1.5f}, {"resolve", 0.25f}};
    status.memory = {{"film", 4096}};
    status.figures = {{"points", 262144.0}};
    status.editsApplied = m_edits;
    status.restarts = m_restarts;
    status.framesPublished = m_published;
    status.estimatedError = m_steps ? 1.0f / float(m_steps) : std::numeric_limits<float>::infinity();
    m_replies.setStatus(status);
  }
}

void FakeRenderer::handle(const Request& request) {
  if (const auto* edit = std::get_if<EditRequest>(&request)) {
    EditAck ack{edit->from, CostClass::relight, 0, 0, false, m_scene.technique};
    for (size_t i = 0; i < edit->edits.size(); ++i) {
      const Edit& one = edit->edits[i];
      const auto* material = std::get_if<SetMaterial>(&one);
      const std::string place = "/edits/" + std::to_string(i) + "/material";
      if (material && material->material >= m_options.materials)
        return m_replies.push(ErrorReply{edit->from, {"out-of-range", "no such material", place}});
      if (const auto* view = std::get_if<SetView>(&one)) {
        m_scene.view = view->view;
        ++m_scene.viewRevision;
        ack.cost = CostClass::regather;
      }
      const auto* sky = std::get_if<SetEnvironment>(&one);
      if (sky && sky->image) m_scene.environment.image = *sky->image;
      if (material && material->roughness) m_scene.materials[material->material].roughness = *material->roughness;
    }
    ack.sceneRevision = ++m_scene.sceneRevision;
    ack.viewRevision = m_scene.viewRevision;
    m_applied[edit->from.client] = edit->from.seq;
    m_editAt = edit->receivedAt;
    m_steps = 0;
    ++m_edits;
    ++m_restarts;
    m_replies.push(ack);
  } else if (const auto* load = std::get_if<LoadRequest>(&request)) {
    m_scene.name = load->loaded->scene.name;
    m_scene.hash = fnv1a(m_scene.name);
    ++m_scene.sceneRevision;
    m_steps = 0;
    m_replies.push(LoadReply{load->from, describe(), 0.5});
  } else if (const auto* pick = std::get_if<PickRequest>(&request)) {
    PickReply reply;
    reply.to = pick->from;
    if (pick->x < m_options.width / 2) reply.node = reply.material = reply.primitive = 0;
    m_replies.push(reply);
  } else if (const auto* save = std::get_if<SaveRequest>(&request)) {
    m_replies.push(SaveReply{save->from, std::make_shared<const std::vector<uint8_t>>(m_options.fileBytes, uint8_t(7))});
  } else if (const auto* ask = std::get_if<DescribeRequest>(&request)) {
    m_replies.push(DescribeReply{ask->from, describe()});
  } else if (const auto* wait = std::get_if<WaitRequest>(&request)) {
    m_waits.push_back(*wait);
  } else if (const auto* watch = std::get_if<WatchRequest>(&request)) {
    m_watched = watch->watched;
  } else if (const auto* leave = std::get_if<LeaveRequest>(&request)) {
    m_applied.erase(leave->client);
    std::erase_if(m_waits, [&](const WaitRequest& w) { return w.from.client == leave->client; });
  }
}

void FakeRenderer::answerWaits() {
  std::erase_if(m_waits, [this](const WaitRequest& wait) {
    if (m_steps < (wait.steps ? wait.steps : m_options.passes)) return false;
    m_replies.push(WaitReply{wait.from, 0xfeedull + m_steps, m_steps, m_steps >= m_options.passes,
                             1.0f / float(m_steps), 0.0f, 2.0f / float(m_steps)});
    return true;
  });
}

std::shared_ptr<const SceneSummary> FakeRenderer::describe() const {
  return std::make_shared<const SceneSummary>(m_scene);
}

void FakeRenderer::publish() {
  auto frame = std::make_shared<Frame>();
  FrameInfo& info = frame->info;
  info.frameId = ++m_frameId;
  info.sceneRevision = m_scene.sceneRevision;
  info.viewRevision = m_scene.viewRevision;
  info.width = m_options.width;
  info.height = m_options.height;
  info.steps = ++m_steps;
  info.phase = m_steps >= m_options.passes ? Phase::converged : m_steps == 1 ? Phase::coarse : Phase::converging;
  info.gatheredShare = 1.0f;
  info.meanSamples = float(m_steps);
  info.estimatedError = 1.0f / float(m_steps);
  info.errorHigh = 2.0f / float(m_steps);
  info.msSinceEdit = m_editAt > 0.0 ? float((nowSeconds() - m_editAt) * 1e3) : 0.0f;
  info.stages = {{"trace", 1.5f}, {"resolve", 0.25f}};
  for (const auto& [client, seq] : m_applied) info.applied.push_back({client, seq});
  frame->rgba = pixels(m_options, info.frameId);
  ++m_published;
  m_frames.publish(std::move(frame));
}

}  // namespace limn::server::testing
