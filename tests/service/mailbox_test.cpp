#include "renderer/session/mailbox.hpp"

#include <atomic>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn {
namespace {

EditRequest viewEdit(uint64_t client, uint32_t seq, double eyeX = 0.0) {
  SetView set;
  set.view.eye.x = eyeX;
  return EditRequest{{client, seq}, {set}, 0.0};
}

EditRequest materialEdit(uint64_t client, uint32_t seq) {
  SetMaterial set;
  set.roughness = 0.5f;
  return EditRequest{{client, seq}, {set}, 0.0};
}

std::vector<uint32_t> seqsOf(const std::vector<Request>& requests) {
  std::vector<uint32_t> seqs;
  for (const Request& request : requests)
    std::visit([&](const auto& r) { if constexpr (requires { r.from; }) seqs.push_back(r.from.seq); }, request);
  return seqs;
}

std::vector<uint32_t> seqsOf(const std::vector<EditAck>& acks) {
  std::vector<uint32_t> seqs;
  for (const EditAck& ack : acks) {
    EXPECT_TRUE(ack.superseded);
    seqs.push_back(ack.to.seq);
  }
  return seqs;
}

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Mailbox, laterViewEditReplacesTheEarlierOne) {
  Mailbox box;
  for (uint32_t seq = 1; seq <= 5; ++seq) ASSERT_TRUE(box.push(viewEdit(1, seq, seq)));
  std::vector<EditAck> superseded;
  const auto requests = box.drain(superseded);
  EXPECT_THAT(seqsOf(requests), ElementsAre(5));
  EXPECT_EQ(std::get<SetView>(std::get<EditRequest>(requests[0]).edits[0]).view.eye.x, 5.0);
  EXPECT_THAT(seqsOf(superseded), ElementsAre(1, 2, 3, 4));
  EXPECT_FALSE(box.waitFor(0.0));
}

TEST(Mailbox, sceneEditsAreNeverDropped) {
  Mailbox box;
  for (uint32_t seq = 1; seq <= 6; ++seq) {
    if (seq % 2 != 0) box.push(viewEdit(1, seq));
    else box.push(materialEdit(1, seq));
  }
  std::vector<EditAck> superseded;
  EXPECT_THAT(seqsOf(box.drain(superseded)), ElementsAre(2, 4, 5, 6));
  EXPECT_THAT(seqsOf(superseded), ElementsAre(1, 3));
}

TEST(Mailbox, anotherClientsViewEditStays) {
  Mailbox box;
  box.push(viewEdit(1, 10));
  box.push(viewEdit(2, 20));
  box.push(viewEdit(1, 11));
  std::vector<EditAck> superseded;
  EXPECT_THAT(seqsOf(box.drain(superseded)), ElementsAre(20, 11));
  ASSERT_EQ(superseded.size(), 1u);
  EXPECT_EQ(superseded[0].to.client, 1u);
}

TEST(Mailbox, viewEditWithASceneEditInTheBatchIsNotViewOnly) {
  Mailbox box;
  EditRequest batch = viewEdit(1, 1);
  batch.edits.push_back(SetMaterial{});
  box.push(batch);
  box.push(viewEdit(1, 2));
  std::vector<EditAck> superseded;
  EXPECT_THAT(seqsOf(box.drain(superseded)), ElementsAre(1, 2));
  EXPECT_THAT(superseded, IsEmpty());
}

TEST(Mailbox, viewEditDoesNotPassARequestThatLooks) {
  Mailbox box;
  box.push(viewEdit(1, 1));
  box.push(PickRequest{{1, 2}, 0, 0});
  box.push(viewEdit(1, 3));
  std::vector<EditAck> superseded;
  EXPECT_THAT(seqsOf(box.drain(superseded)), ElementsAre(1, 2, 3));
  EXPECT_THAT(superseded, IsEmpty());
}

TEST(Mailbox, emptyBatchSupersedesNothing) {
  Mailbox box;
  box.push(viewEdit(1, 1));
  box.push(EditRequest{{1, 2}, {}, 0.0});
  std::vector<EditAck> superseded;
  EXPECT_THAT(seqsOf(box.drain(superseded)), ElementsAre(1, 2));
}

TEST(Mailbox, fullBoxRefusesAndDrainingMakesRoom) {
  Mailbox box;
  for (size_t i = 0; i < Mailbox::kMaxPending; ++i) ASSERT_TRUE(box.push(materialEdit(1, uint32_t(i + 1))));
  EXPECT_FALSE(box.push(materialEdit(1, 9999)));
  std::vector<EditAck> superseded;
  EXPECT_EQ(box.drain(superseded).size(), Mailbox::kMaxPending);
  EXPECT_TRUE(box.push(materialEdit(1, 10000)));
}

TEST(Mailbox, supersededAcksAreBoundedToo) {
  Mailbox box;
  size_t taken = 0;
  for (size_t i = 0; i < 2 * Mailbox::kMaxPending; ++i) taken += box.push(viewEdit(1, uint32_t(i + 1))) ? 1 : 0;
  EXPECT_EQ(taken, Mailbox::kMaxPending);
  std::vector<EditAck> superseded;
  EXPECT_EQ(box.drain(superseded).size() + superseded.size(), Mailbox::kMaxPending);
}

TEST(Mailbox, closedBoxRefusesButGivesWhatWaits) {
  Mailbox box;
  box.push(materialEdit(1, 1));
  box.close();
  EXPECT_TRUE(box.closed());
  EXPECT_FALSE(box.push(materialEdit(1, 2)));
  std::vector<EditAck> superseded;
  EXPECT_THAT(seqsOf(box.drain(superseded)), ElementsAre(1));
  EXPECT_FALSE(box.waitFor(1000.0));
}

TEST(Mailbox, waitEndsWhenSomethingArrives) {
  Mailbox box;
  std::thread writer([&] { box.push(materialEdit(1, 1)); });
  EXPECT_TRUE(box.waitFor(1000.0));
  writer.join();
}

TEST(Mailbox, waitEndsWhenTheTimeIsOver) {
  Mailbox box;
  EXPECT_FALSE(box.waitFor(0.0));
}

TEST(Mailbox, everyEditOfManyThreadsIsAnsweredOnce) {
  constexpr uint32_t kClients = 4, kEdits = 500;
  Mailbox box;
  std::vector<std::thread> writers;
  for (uint64_t client = 1; client <= kClients; ++client)
    writers.emplace_back([&box, client] {
      for (uint32_t seq = 1; seq <= kEdits; ++seq) {
        if (seq % 3 == 0) box.push(materialEdit(client, seq));
        else box.push(viewEdit(client, seq));
      }
    });
  std::vector<uint32_t> applied(kClients + 1), superseded(kClients + 1), newest(kClients + 1);
  uint32_t answered = 0;
  while (answered < kClients * kEdits) {
    box.waitFor(1000.0);
    std::vector<EditAck> replaced;
    for (const Request& request : box.drain(replaced)) {
      const Origin from = std::get<EditRequest>(request).from;
      EXPECT_GT(from.seq, newest[from.client]);
      newest[from.client] = from.seq;
      ++applied[from.client];
      ++answered;
    }
    for (const EditAck& ack : replaced) ++superseded[ack.to.client];
    answered += uint32_t(replaced.size());
  }
  for (std::thread& writer : writers) writer.join();
  for (uint32_t client = 1; client <= kClients; ++client) {
    EXPECT_EQ(applied[client] + superseded[client], kEdits);
    EXPECT_EQ(newest[client], kEdits);
  }
}

TEST(FrameSlot, newestWinsAndWakes) {
  FrameSlot slot;
  EXPECT_EQ(slot.newest(), nullptr);
  int wakes = 0;
  slot.onPublish([&] { ++wakes; });
  for (uint64_t id = 1; id <= 3; ++id) {
    auto frame = std::make_shared<Frame>();
    frame->info.frameId = id;
    slot.publish(frame);
  }
  EXPECT_EQ(slot.newest()->info.frameId, 3u);
  EXPECT_EQ(wakes, 3);
}

TEST(StatusQueue, repliesKeepTheirOrderAndStatusIsReplaced) {
  StatusQueue queue;
  int wakes = 0;
  queue.onPush([&] { ++wakes; });
  queue.push(EditAck{{1, 1}});
  queue.push(ErrorReply{{1, 2}, {"bad", "no", ""}});
  Status status;
  status.steps = 7;
  queue.setStatus(status);
  const auto replies = queue.drain();
  ASSERT_EQ(replies.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<EditAck>(replies[0]));
  EXPECT_TRUE(std::holds_alternative<ErrorReply>(replies[1]));
  EXPECT_EQ(queue.status().steps, 7u);
  EXPECT_EQ(wakes, 2);
  EXPECT_THAT(queue.drain(), IsEmpty());
}

}  // namespace
}  // namespace limn
