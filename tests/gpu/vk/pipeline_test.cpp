#include "tests/gpu/vk/vk_fixture.hpp"

#include <array>

#include "tests/gpu/vk/scale.spv.hpp"
#include "tests/gpu/vk/texel.spv.hpp"

namespace limn::vk {
namespace {

struct ScalePush {
  uint32_t first, count, scale;
};

ComputePipeline scalePipeline(Device& device, uint32_t add, uint32_t groupSize) {
  PipelineDesc desc;
  desc.name = "scale";
  desc.spirv = scaleSpirv;
  desc.layout = {{0, BindingKind::storage}, {3, BindingKind::storage}};
  desc.pushConstantBytes = sizeof(ScalePush);
  desc.specialization = {add, groupSize};
  return must(ComputePipeline::create(device, desc));
}

class PipelineTest : public OnEveryPath {
 protected:
  Buffer makeBuffer(const std::vector<uint32_t>& values, const std::string& name,
                    BufferUsage usage = BufferUsage::storage) {
    return must(createBufferWith<uint32_t>(*device, storageDesc(0, name, usage), values));
  }
  std::vector<uint32_t> words(const Buffer& buffer) {
    return must(readBackArray<uint32_t>(*device, buffer, buffer.size() / 4));
  }
};
INSTANTIATE_TEST_SUITE_P(Paths, PipelineTest, testing::ValuesIn(kDevicePaths), pathName);

TEST_P(PipelineTest, PushAndSpecializationConstantsReachTheShader) {
  const Buffer in = makeBuffer({1, 2, 3, 4, 5, 6, 7, 8}, "in");
  const Buffer out = makeBuffer({0, 0, 0, 0}, "out");
  const std::array bindings{storage(0, in), storage(3, out)};
  const ComputePipeline plus5 = scalePipeline(*device, 5, 4);
  const ComputePipeline plus100 = scalePipeline(*device, 100, 2);
  CommandRecorder recorder(*device);
  recorder.begin();
  recorder.dispatch(plus5, bindings, pushBytes(ScalePush{2, 3, 10}), 1);
  finish(*device, recorder);
  EXPECT_EQ(words(out), (std::vector<uint32_t>{35, 45, 55, 0}));
  recorder.begin();
  recorder.dispatch(plus100, bindings, pushBytes(ScalePush{0, 4, 1}), 1);  // one group of 2
  finish(*device, recorder);
  EXPECT_EQ(words(out), (std::vector<uint32_t>{101, 102, 55, 0}));
}

TEST_P(PipelineTest, ABindingMayBePartOfABuffer) {
  const uint32_t align = device->limits().storageOffsetAlignment / 4 + (device->limits().storageOffsetAlignment < 4);
  std::vector<uint32_t> values(4 * align);
  values[2 * align] = 21;
  const Buffer in = makeBuffer(values, "in");
  const Buffer out = makeBuffer(std::vector<uint32_t>(4 * align), "out");
  const std::array bindings{storage(0, in, 2 * align * 4, 4), storage(3, out, align * 4)};
  const ComputePipeline pipeline = scalePipeline(*device, 0, 1);
  CommandRecorder recorder(*device);
  recorder.begin();
  recorder.dispatch(pipeline, bindings, pushBytes(ScalePush{0, 1, 2}), 1);
  finish(*device, recorder);
  EXPECT_EQ(words(out)[align], 42u);
}

TEST_P(PipelineTest, ABarrierOrdersWriterAndReader) {
  const Buffer a = makeBuffer(std::vector<uint32_t>(256, 1), "a");
  const Buffer b = makeBuffer(std::vector<uint32_t>(256, 0), "b");
  const std::array forth{storage(0, a), storage(3, b)};
  const std::array back{storage(0, b), storage(3, a)};
  const ComputePipeline pipeline = scalePipeline(*device, 1, 8);
  CommandRecorder recorder(*device);
  recorder.begin();
  for (int i = 0; i < 5; ++i) {
    recorder.dispatch(pipeline, forth, pushBytes(ScalePush{0, 256, 1}), 32);
    recorder.barrier();
    recorder.dispatch(pipeline, back, pushBytes(ScalePush{0, 256, 1}), 32);
    recorder.barrier();
  }
  finish(*device, recorder);
  EXPECT_EQ(words(a), std::vector<uint32_t>(256, 11));
}

TEST_P(PipelineTest, ManyDispatchesInOneRecordingKeepTheirOwnBindings) {
  std::vector<Buffer> targets;
  const Buffer in = makeBuffer({3}, "in");
  const ComputePipeline pipeline = scalePipeline(*device, 0, 1);
  CommandRecorder recorder(*device);
  for (uint32_t i = 0; i < 150; ++i) targets.push_back(makeBuffer({0}, "target"));
  for (int round = 0; round < 3; ++round) {
    recorder.begin();
    for (uint32_t i = 0; i < 150; ++i) {
      const std::array bindings{storage(0, in), storage(3, targets[i])};
      recorder.dispatch(pipeline, bindings, pushBytes(ScalePush{0, 1, i}), 1);
    }
    finish(*device, recorder);
  }
  for (uint32_t i = 0; i < 150; ++i) EXPECT_EQ(words(targets[i])[0], 3 * i);
}

TEST_P(PipelineTest, TexelAndUniformBuffersAreRead) {
  std::vector<float> floats;
  for (int i = 0; i < 16 * 4; ++i) floats.push_back(float(i));
  BufferDesc desc = storageDesc(0, "floats", BufferUsage::texel);
  desc.texelFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  const Buffer texels = must(createBufferWith<float>(*device, desc, floats));
  desc.name = "words";
  desc.texelFormat = VK_FORMAT_R32_UINT;
  std::vector<uint32_t> integers;
  for (uint32_t i = 0; i < 16; ++i) integers.push_back(1000 * i);
  const Buffer integerTexels = must(createBufferWith<uint32_t>(*device, desc, integers));
  const std::array<float, 4> bias{0.25f, 0.5f, 0.75f, 1.0f};
  const Buffer block =
      must(createBufferWith<float>(*device, storageDesc(0, "block", BufferUsage::uniform), bias));
  const Buffer out = must(Buffer::create(*device, storageDesc(16 * 16, "out")));

  PipelineDesc pipelineDesc;
  pipelineDesc.name = "texel";
  pipelineDesc.spirv = texelSpirv;
  pipelineDesc.layout = {{0, BindingKind::texel}, {1, BindingKind::texel}, {2, BindingKind::uniform},
                         {3, BindingKind::storage}};
  const ComputePipeline pipeline = must(ComputePipeline::create(*device, pipelineDesc));
  const std::array bindings{texel(0, texels), texel(1, integerTexels), uniform(2, block), storage(3, out)};
  CommandRecorder recorder(*device);
  recorder.begin();
  recorder.dispatch(pipeline, bindings, {}, 2);
  finish(*device, recorder);
  const auto result = must(readBackArray<float>(*device, out, 64));
  for (size_t i = 0; i < 64; ++i) EXPECT_EQ(result[i], float(i) + 1000 * float(i / 4) + bias[i % 4]) << i;
}

TEST_P(PipelineTest, WarmUpRunsNothingAndLeavesNoFirstUseBehind) {
  const Buffer in = makeBuffer({1}, "in");
  const Buffer out = makeBuffer({77}, "out");
  const std::array bindings{storage(0, in), storage(3, out)};
  const ComputePipeline pipeline = scalePipeline(*device, 0, 1);
  EXPECT_EQ(device->pipelineStats().created, 1u);
  EXPECT_GT(device->pipelineStats().createMs, 0.0);
  EXPECT_EQ(device->pipelineStats().firstUses, 0u);
  CommandRecorder recorder(*device);
  recorder.begin();
  recorder.warmUp(pipeline, bindings);
  finish(*device, recorder);
  EXPECT_EQ(words(out)[0], 77u);
  const PipelineStats warm = device->pipelineStats();
  EXPECT_EQ(warm.firstUses, 1u);
  recorder.begin();
  recorder.dispatch(pipeline, bindings, pushBytes(ScalePush{0, 1, 9}), 1);
  finish(*device, recorder);
  EXPECT_EQ(words(out)[0], 9u);
  EXPECT_EQ(device->pipelineStats().created, warm.created);
  EXPECT_EQ(device->pipelineStats().firstUses, warm.firstUses);
}

}  // namespace
}  // namespace limn::vk
