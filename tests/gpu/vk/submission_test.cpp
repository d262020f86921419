#include "tests/gpu/vk/vk_fixture.hpp"

#include <algorithm>
#include <array>

#include "renderer/base/clock.hpp"
#include "tests/gpu/vk/spin.spv.hpp"

namespace limn::vk {
namespace {

class SubmissionTest : public testing::Test {
 protected:
  SubmissionTest() {
    PipelineDesc desc;
    desc.name = "spin";
    desc.spirv = spinSpirv;
    desc.layout = {{0, BindingKind::storage}};
    desc.pushConstantBytes = 4;
    m_spin = must(ComputePipeline::create(*device, desc));
    m_state = must(Buffer::create(*device, storageDesc(4, "state")));
    must(fill(*device, m_state, 0, 4, 1));
  }

  /// In dispatches of 50,000 turns: lavapipe leaves loops after 65,535.
  void spin(CommandRecorder& recorder, uint32_t turns) {
    for (uint32_t done = 0; done < turns; done += kTurnsPerDispatch) {
      const uint32_t part = std::min(kTurnsPerDispatch, turns - done);
      recorder.dispatch(m_spin, std::array{storage(0, m_state)}, pushBytes(part), 1);
      recorder.barrier();
    }
  }
  uint64_t submitSpin(uint32_t turns) {
    CommandRecorder recorder(*device);
    recorder.begin();
    spin(recorder, turns);
    recorder.end();
    return must(device->submit(recorder));
  }

  static constexpr uint32_t kTurnsPerDispatch = 50'000;
  static constexpr uint32_t kLong = 20'000'000;  // dependent turns: no device does them in a millisecond
  ValidatedDevice device;
  ComputePipeline m_spin;
  Buffer m_state;
};

TEST_F(SubmissionTest, TimelineValuesCountUpAndAreReachedInOrder) {
  const uint64_t first = submitSpin(10);
  const uint64_t second = submitSpin(10);
  EXPECT_EQ(second, first + 1);
  EXPECT_EQ(device->lastSubmitted(), second);
  EXPECT_FALSE(device->reached(second + 1));
  must(device->wait(second));
  EXPECT_TRUE(device->reached(first));
  EXPECT_TRUE(device->reached(second));
  must(device->wait(first));
  must(device->wait(0));
}

TEST_F(SubmissionTest, AWaitThatIsTooShortSaysSo) {
  const uint64_t value = submitSpin(kLong);
  const auto waited = device->wait(value, 0);
  ASSERT_FALSE(waited.ok());
  EXPECT_EQ(waited.error().code, "timeout");
  EXPECT_FALSE(device->reached(value));
  must(device->wait(value));
  EXPECT_TRUE(device->reached(value));
}

TEST_F(SubmissionTest, WorkInFlightKeepsWhatItsOwnerDropped) {
  const uint64_t before = device->memory().totalBytes();
  Buffer target = must(Buffer::create(*device, storageDesc(4096, "dropped")));
  CommandRecorder recorder(*device);
  recorder.begin();
  spin(recorder, kLong);
  recorder.fillBuffer(target, 0, 4096, 5);
  recorder.end();
  const uint64_t value = must(device->submit(recorder));
  target = Buffer();
  EXPECT_GT(device->memory().totalBytes(), before);
  must(device->wait(value));
  EXPECT_EQ(device->memory().totalBytes(), before);
}

TEST_F(SubmissionTest, ARecorderThatIsDroppedLeavesNothingBehind) {
  {
    CommandRecorder recorder(*device);
    recorder.begin();
    spin(recorder, 1);
  }
  {
    CommandRecorder recorder(*device);
    recorder.begin();
    recorder.end();
  }
  must(device->wait(submitSpin(1)));
}

TEST_F(SubmissionTest, SubmissionsNeedNoBarrierBetweenThem) {
  for (int i = 0; i < 20; ++i) submitSpin(1000);
  must(device->waitIdle());
  uint32_t expected = 1;
  for (int i = 0; i < 20; ++i) {
    for (uint32_t turn = 0; turn < 1000; ++turn) expected = (expected ^ (expected >> 7)) * 1664525u + turn;
  }
  EXPECT_EQ(must(readBackArray<uint32_t>(*device, m_state, 1))[0], expected);
}

}  // namespace
}  // namespace limn::vk
