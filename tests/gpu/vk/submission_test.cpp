#include "tests/gpu/vk/vk_fixture.hpp"

#include <algorithm>
#include <array>

#include "renderer/base/clock.hpp"
#include "renderer/vk/readback_ring.hpp"
#include "renderer/vk/timestamp_pool.hpp"
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

TEST_F(SubmissionTest, TimestampsGrowAndNameTheirStages) {
  TimestampPool pool = must(TimestampPool::create(*device, 3, "stages"));
  for (int round = 0; round < 2; ++round) {
    CommandRecorder recorder(*device);
    recorder.begin();
    pool.reset(recorder);
    pool.begin(recorder, "trace");
    spin(recorder, kLong);
    pool.end(recorder);
    pool.begin(recorder, "film");
    spin(recorder, 1000);
    pool.end(recorder);
    finish(*device, recorder);
    const auto stages = must(pool.read());
    ASSERT_EQ(stages.size(), 2u);
    EXPECT_EQ(stages[0].stage, "trace");
    EXPECT_EQ(stages[1].stage, "film");
    if (device->limits().timestampPeriodNs == 0) continue;
    const auto ticks = must(pool.readTicks());
    for (size_t i = 1; i < ticks.size(); ++i) EXPECT_GE(ticks[i], ticks[i - 1]) << i;
    // A stage lasts as long as its two ticks say.
    ASSERT_EQ(ticks.size(), 4u);
    for (size_t i = 0; i < 2; ++i) {
      const double ms = double(ticks[2 * i + 1] - ticks[2 * i]) * device->limits().timestampPeriodNs * 1e-6;
      EXPECT_NEAR(stages[i].ms, ms, 1e-6 * ms) << i;
    }
    EXPECT_GT(stages[0].ms, 0.0);
  }
}

class ReadbackRingTest : public SubmissionTest {
 protected:
  /// Sends one word through the ring; false when no slot is free.
  bool send(ReadbackRing& ring, uint32_t word) {
    const auto slot = ring.take();
    if (!slot) return false;
    CommandRecorder recorder(*device);
    recorder.begin();
    recorder.fillBuffer(m_state, 0, 4, word);
    recorder.barrier();
    ring.copy(recorder, *slot, m_state, 0, 4);
    recorder.end();
    ring.submitted(*slot, must(device->submit(recorder)));
    return true;
  }
  uint32_t receive(ReadbackRing& ring) {
    const auto slot = ring.ready();
    EXPECT_TRUE(slot.has_value());
    const uint32_t word = *reinterpret_cast<const uint32_t*>(ring.bytes(*slot).data());
    ring.release(*slot);
    return word;
  }
};

TEST_F(ReadbackRingTest, SlotsComeBackInOrderAndAreUsedAgain) {
  ReadbackRing ring = must(ReadbackRing::create(*device, 4, 3, "ring", "test"));
  EXPECT_FALSE(ring.ready().has_value());
  for (uint32_t round = 0; round < 4; ++round) {
    for (uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(send(ring, 10 * round + i));
    EXPECT_FALSE(send(ring, 99));
    must(device->waitIdle());
    EXPECT_EQ(receive(ring), 10 * round);
    EXPECT_TRUE(send(ring, 10 * round + 3));
    must(device->waitIdle());
    for (uint32_t i = 1; i < 4; ++i) EXPECT_EQ(receive(ring), 10 * round + i);
    EXPECT_EQ(ring.pending(), 0u);
  }
}

TEST_F(ReadbackRingTest, ASlotIsNotReadyBeforeItsWorkIsDone) {
  ReadbackRing ring = must(ReadbackRing::create(*device, 4, 2, "ring", "test"));
  const auto unsent = ring.take();
  ASSERT_TRUE(unsent.has_value());
  EXPECT_FALSE(ring.ready().has_value());
  ring.release(*unsent);
  submitSpin(kLong);
  ASSERT_TRUE(send(ring, 6));
  EXPECT_FALSE(ring.ready().has_value());
  must(device->waitIdle());
  EXPECT_EQ(receive(ring), 6u);
}

TEST_F(ReadbackRingTest, AShaderMayWriteIntoTheSlot) {
  ReadbackRing ring = must(ReadbackRing::create(*device, 4, 2, "ring", "test"));
  const auto slot = ring.take();
  CommandRecorder recorder(*device);
  recorder.begin();
  recorder.fillBuffer(ring.buffer(*slot), 0, 4, 12);
  recorder.barrier();
  recorder.dispatch(m_spin, std::array{storage(0, ring.buffer(*slot))}, pushBytes(uint32_t(1)), 1);
  recorder.end();
  ring.submitted(*slot, must(device->submit(recorder)));
  must(device->waitIdle());
  EXPECT_EQ(receive(ring), 12u * 1664525u);
}

}  // namespace
}  // namespace limn::vk
