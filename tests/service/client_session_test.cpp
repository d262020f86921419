// What waits for one client.
#include "server/client_session.hpp"

#include <gtest/gtest.h>

namespace limn::server::testing {
namespace {

std::string next(ClientSession& session) {
  const std::optional<OutgoingMessage> message = session.takeQueued();
  return message ? message->head : "nothing";
}

TEST(ClientSession, onlyTheNewestSceneOfOthersWaits) {
  ClientSession session(1, 0.0);
  const std::string scene(ClientSession::kMaxQueuedBytes / 8, 's');
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(session.queueScene(scene)) << "it is no reason to cut a client off";
  ASSERT_TRUE(session.queue("ack"));
  ASSERT_TRUE(session.queueScene("newest"));
  EXPECT_EQ(next(session), "ack");
  EXPECT_EQ(next(session), "newest") << "it holds what was acknowledged before";
  EXPECT_EQ(next(session), "nothing");
}

TEST(ClientSession, aLoadedSceneComesAfterNoneThatIsOlder) {
  ClientSession session(1, 0.0);
  ASSERT_TRUE(session.queueScene("edited"));
  session.dropScene();
  ASSERT_TRUE(session.queue("loaded"));
  ASSERT_TRUE(session.queueScene("edited again"));
  EXPECT_EQ(next(session), "loaded");
  EXPECT_EQ(next(session), "edited again");
  EXPECT_EQ(next(session), "nothing");
}

TEST(ClientSession, scenesOfOthersLeavePicturesTheirTurn) {
  ClientSession session(1, 0.0);
  session.ready = std::make_shared<const EncodedFrame>();
  ASSERT_TRUE(session.queueScene("first"));
  EXPECT_FALSE(session.pictureIsNext());
  next(session);
  ASSERT_TRUE(session.queueScene("second"));
  EXPECT_TRUE(session.pictureIsNext()) << "a scene went already";
  session.dropScene();
  ASSERT_TRUE(session.queue("ack"));
  EXPECT_FALSE(session.pictureIsNext()) << "answers do not wait";
}

}  // namespace
}  // namespace limn::server::testing
