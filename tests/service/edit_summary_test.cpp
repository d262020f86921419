// The newest value of everything that was edited: what an old scene needs to become the present one.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/service/accepted_edits.hpp"

namespace limn::server::testing {
namespace {

TEST(EditSummary, keepsTheNewestOfEachThing) {
  const Messages edits = someEdits();
  protocol::MaterialEdit both;
  both.material = 2;
  both.clearcoat = 0.1f;
  both.roughness = 0.75f;
  const Messages before = summaryOf(edits, 6);
  ASSERT_EQ(before.size(), 4u) << "technique, view, environment and one material";
  EXPECT_NE(std::find(before.begin(), before.end(), edited(both)), before.end());
  const Messages after = summaryOf(edits, edits.size());
  ASSERT_EQ(after.size(), 5u);
  EXPECT_EQ(after[0], protocol::ClientMessage(protocol::Load{1, "rooms/käse.glb"}));
  EXPECT_EQ(after[2], edits[6]) << "another scene is shown by the same technique";
  EXPECT_EQ(Messages(after.begin() + 3, after.end()), (Messages{view(4.0), roughness(1, 0.5f)}))
      << "and has nothing else of the one before";
}

TEST(EditSummary, keepsEveryLensThatAFileMayHave) {
  for (const float yfov : {1e-4f, 3.1405926f, 3.1405928f})
    for (const float metres : {1e-45f, 1e-12f, 1e30f}) {
      protocol::CameraEdit edit;
      edit.view.up = {0.0, 1.0, 0.0};
      edit.view.yfov = yfov;
      edit.view.ymag = edit.view.znear = metres;
      const Messages edits{edited(edit)};
      EXPECT_EQ(summaryOf(edits, 1), edits) << yfov << " rad, " << metres << " m";
    }
}

TEST(EditSummary, passesOverWhatCannotBeSaid) {
  protocol::CameraEdit edit;
  edit.view.yfov = 4.0f;
  const Messages edits{edited(edit), roughness(1, 0.5f)};
  EXPECT_EQ(summaryOf(edits, 2), (Messages{edits[1]}));
}

TEST(EditSummary, aChangeOfTechniqueBeginsWithDefaults) {
  EditSummary summary;
  const Messages edits{technique({}, {{"maxBounces", 3.0}}), technique("point-projection", {{"bounces", 2.0}}),
                       technique({}, {{"points", 65536.0}}), technique("path-tracing", {})};
  for (size_t i = 0; i < 3; ++i) summary.add({edits[i]});
  EXPECT_EQ(messagesOf(summary), (Messages{edits[0], technique("point-projection", {{"bounces", 2.0}, {"points", 65536.0}})}));
  summary.add({edits[3]});
  EXPECT_EQ(messagesOf(summary), (Messages{edits[3]})) << "nothing is left of the technique before";
}

TEST(EditSummary, forgetsWhatIsRefusedAndNoMore) {
  EditSummary summary;
  protocol::MaterialEdit material;
  material.material = 2;
  material.roughness = material.metallic = 0.5f;
  protocol::CameraEdit camera;
  camera.view.up = {0.0, 1.0, 0.0};
  const protocol::TechniqueEdit chosen{"path-tracing", {{{"gone", 1.0}, {"bounces", 2.0}}}};
  for (const auto& edit : {edited(material), edited(camera), edited(chosen), edited(protocol::ImageEdit{640, 480})}) summary.add({edit});
  EXPECT_TRUE(summary.forget(chosen, "/parameters/gone"));
  EXPECT_TRUE(summary.forget(material, "/roughness"));
  EXPECT_TRUE(summary.forget(camera, "/view/target")) << "half a view is none";
  material.roughness = std::nullopt;
  EXPECT_EQ(messagesOf(summary),
            (Messages{protocol::Batch{1, {protocol::ImageEdit{640, 480}, protocol::TechniqueEdit{"path-tracing", {{{"bounces", 2.0}}}}}},
                      edited(material)}));
  EXPECT_TRUE(summary.forget(chosen, "/technique")) << "its parameters are nobody else's";
  EXPECT_TRUE(summary.forget(material, "/material"));
  EXPECT_EQ(messagesOf(summary), (Messages{edited(protocol::ImageEdit{640, 480})}));
  EXPECT_FALSE(summary.forget(material, "/metallic"));
}

TEST(EditSummary, aSkyThatIsRefusedLeavesItsLight) {
  EditSummary summary;
  protocol::EnvironmentEdit light, image;
  light.radiance = {0.5, 0.5, 0.5};
  image.image = "sky.hdr";
  summary.add({edited(light)});
  summary.add({edited(image)});
  EXPECT_TRUE(summary.forget(image, ""));
  EXPECT_EQ(messagesOf(summary), (Messages{edited(light)}));
  EXPECT_TRUE(summary.forget(light, ""));
  EXPECT_EQ(messagesOf(summary), Messages{});
}

TEST(EditSummary, aSizeComesWithItsTechnique) {
  EditSummary summary;
  const protocol::ImageEdit size{640, 480};
  protocol::ResolveEdit display;
  display.exposure = 1.5f;
  const protocol::TechniqueEdit chosen{"point-projection", {}};
  for (const auto& edit : {edited(size), edited(display), edited(chosen), protocol::ClientMessage(protocol::Load{3, "b.glb"})})
    summary.add({edit});
  EXPECT_EQ(messagesOf(summary),
            (Messages{protocol::Load{1, "b.glb"}, protocol::Batch{1, {size, chosen}}, edited(display)}));
}

}  // namespace
}  // namespace limn::server::testing
