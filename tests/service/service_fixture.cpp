#include "tests/service/service_fixture.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <filesystem>

#include "renderer/base/clock.hpp"

namespace limn::server::testing {

protocol::TrafficRecorder& traffic() {
  static protocol::TrafficRecorder recorder(LIMN_TRAFFIC_DIR);
  return recorder;
}

TestService::TestService(const Options& options) {
  ServiceConfig config;
  config.techniques = {{"fake",
                        "Fake",
                        "Draws stripes.",
                        false,
                        {{"depth", "how deep", "1", ParameterType::integer, 1, 8, 3, CostClass::regather}}}};
  config.layers = {"beauty", "albedo"};
  config.stages = {"trace", "resolve"};
  config.assetRoot = std::filesystem::temp_directory_path();
  config.readers.scene = [](const std::filesystem::path& file) -> Result<LoadedScene> {
    LoadedScene loaded;
    loaded.scene.name = file.filename().string();
    return loaded;
  };
  options.configure(config);
  Result<std::unique_ptr<Service>> opened = Service::open(std::move(config), mailbox, frames, replies);
  if (!opened) ADD_FAILURE() << opened.error().text();
  service = opened.take();
  renderer = std::make_unique<FakeRenderer>(options.renderer, mailbox, frames, replies);
  service->begin(renderer->view(), options.kept);
  if (options.ready) service->setReady(true);
  loop = std::thread([this] { service->run(); });
}

TestService::~TestService() {
  service->drain();
  loop.join();
  renderer.reset();
  service.reset();
}

std::optional<double> TestService::tryMetric(const std::string& name) const {
  RawClient client(port());
  const RawClient::Reply reply = client.request("GET /metrics HTTP/1.1", {"Host: localhost"});
  const std::string line = "\n" + name + " ";
  const size_t at = reply.body.find(line);
  if (at == std::string::npos) return std::nullopt;
  return std::stod(reply.body.substr(at + line.size()));
}

double TestService::metric(const std::string& name) const {
  const auto value = tryMetric(name);
  EXPECT_TRUE(value) << "no metric " << name;
  return value.value_or(-1.0);
}

void TestService::waitForMetric(const std::string& name, double value) const {
  const double end = nowSeconds() + RawClient::kPatience;
  while (nowSeconds() < end)
    if (tryMetric(name) == value) return;
  ADD_FAILURE() << name << " never became " << value << ", it is " << metric(name);
}

protocol::ServerHello TestClient::greet(std::optional<bool> watch,
                                        std::optional<std::vector<protocol::Encoding>> encodings) {
  protocol::ClientHello hello;
  hello.seq = nextSeq();
  hello.version = protocol::kVersion;
  hello.client = "test";
  hello.watch = watch;
  hello.encodings = std::move(encodings);
  send(hello);
  return await<protocol::ServerHello>();
}

void TestClient::send(const protocol::ClientMessage& message) {
  const std::string json = protocol::encode(message);
  const Result<void> valid = traffic().text(protocol::Direction::toServer, json);
  EXPECT_TRUE(valid.ok()) << valid.error().text() << " in " << json;
  EXPECT_TRUE(socket.sendText(json));
}

void TestClient::acknowledge(uint32_t frameId) {
  protocol::AckFrame ack;
  ack.seq = nextSeq();
  ack.frameId = frameId;
  const std::string json = protocol::encode(protocol::ClientMessage(ack));
  EXPECT_TRUE(traffic().text(protocol::Direction::toServer, json).ok());
  socket.sendText(json);   // the server may have gone meanwhile
}

bool TestClient::step() {
  text.reset();
  picture.reset();
  const auto message = socket.receive();
  EXPECT_FALSE(socket.timedOut()) << "the server fell silent";
  if (!message) return false;
  longestFragment = std::max(longestFragment, uint32_t(message->longestFragment));
  if (message->opcode == RawClient::Opcode::close) {
    closeCode = message->closeCode();
    socket.sendFrame(RawClient::Opcode::close, message->payload);
    return false;
  }
  if (message->opcode == RawClient::Opcode::text) {
    const Result<void> valid = traffic().text(protocol::Direction::toClient, message->payload);
    EXPECT_TRUE(valid.ok()) << valid.error().text() << " in " << message->payload;
    const auto decoded = protocol::decodeServer(message->payload);
    if (decoded.ok()) text = *decoded;
    return true;
  }
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(message->payload.data()),
                                       message->payload.size());
  const Result<void> valid = traffic().frame(bytes);
  EXPECT_TRUE(valid.ok()) << valid.error().text();
  const auto frame = protocol::decodeFrame(bytes);
  if (!frame.ok()) return true;
  picture = Picture{frame->header, {frame->payload.begin(), frame->payload.end()}};
  if (frame->header.kind == protocol::FrameKind::image) {
    ++picturesSeen;
    if (acknowledges) acknowledge(frame->header.frameId);
  }
  return true;
}

TestClient::Picture TestClient::awaitPicture(const std::function<bool(const protocol::FrameHeader&)>& wanted) {
  while (step())
    if (picture && wanted(picture->header)) return *picture;
  ADD_FAILURE() << "no such picture came";
  return {};
}

std::vector<uint8_t> decodeImage(const std::vector<uint8_t>& bytes, protocol::Encoding encoding, uint32_t& width,
                                 uint32_t& height) {
  std::vector<uint8_t> rgb;
  if (encoding == protocol::Encoding::png) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
    image.format = PNG_FORMAT_RGB;
    rgb.resize(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr));
    width = image.width;
    height = image.height;
    return rgb;
  }
  const tjhandle decoder = tjInitDecompress();
  int w = 0, h = 0, sampling = 0, space = 0;
  EXPECT_EQ(tjDecompressHeader3(decoder, bytes.data(), bytes.size(), &w, &h, &sampling, &space), 0);
  rgb.resize(size_t(w) * size_t(h) * 3);
  EXPECT_EQ(tjDecompress2(decoder, bytes.data(), bytes.size(), rgb.data(), w, 0, h, TJPF_RGB, 0), 0);
  tjDestroy(decoder);
  width = uint32_t(w);
  height = uint32_t(h);
  return rgb;
}

protocol::SetMessage setRoughness(uint32_t seq, uint32_t material, float roughness) {
  protocol::MaterialEdit edit;
  edit.material = material;
  edit.roughness = roughness;
  return {seq, edit};
}

protocol::SetCamera moveCamera(uint32_t seq, double x) {
  protocol::SetCamera camera;
  camera.seq = seq;
  camera.view.eye = {x, 1.0, 2.0};
  camera.view.up = {0.0, 1.0, 0.0};
  return camera;
}

}  // namespace limn::server::testing
