// Edits: what is accepted, what changes, and what the ChangeSet says about it.
#include "renderer/scene/edit.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "renderer/scene/reach.hpp"

namespace limn {
namespace {

/// Nodes: 0 -> 1 -> {2, 3}, and 4 by itself.
Scene smallScene() {
  Scene scene;
  scene.materials.resize(2);
  scene.lights.resize(2);
  scene.nodes.resize(5);
  const auto link = [&](uint32_t parent, uint32_t child) {
    scene.nodes[parent].children.push_back(child);
    scene.nodes[child].parent = int32_t(parent);
  };
  link(0, 1), link(1, 2), link(1, 3);
  scene.roots = {0, 4};
  return scene;
}

ChangeSet applied(Scene& scene, const std::vector<Edit>& edits) {
  ResolveSettings resolve;
  for (const Edit& edit : edits) EXPECT_TRUE(validate(scene, edit).ok());
  return apply(scene, resolve, edits).changes;
}

std::string complaint(const Edit& edit) {
  const Result<void> result = validate(smallScene(), edit);
  if (result) return "";
  EXPECT_EQ(result.error().code, "out-of-range");
  EXPECT_FALSE(result.error().message.empty());
  return result.error().place;
}

SetView viewEdit(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up = {0, 1, 0}) {
  SetView edit;
  edit.view.eye = eye, edit.view.target = target, edit.view.up = up;
  return edit;
}

TEST(EditApply, NothingChangesNothing) {
  Scene scene = smallScene();
  EXPECT_TRUE(applied(scene, {}).empty());
  EXPECT_EQ(applied(scene, {}).cost(), CostClass::none);
}

TEST(EditApply, PresentValuesChangeNothing) {
  Scene scene = smallScene();
  const Material m = scene.materials[1];
  const uint64_t before = scene.hash();
  const ChangeSet set = applied(
      scene, {SetMaterial{.material = 1, .baseColor = m.baseColor, .roughness = m.roughness, .emission = m.emission},
              SetLight{.light = 0, .intensity = scene.lights[0].intensity},
              SetNodeTransform{
                  .node = 2, .translation = glm::dvec3(0), .rotation = glm::dquat(1, 0, 0, 0), .scale = glm::dvec3(1)},
              SetEnvironment{.radiance = glm::vec3(0)}, SetView{scene.view}, SetResolve{.exposure = 0.0f},
              SetTechnique{}, SetImageSize{64, 64}});
  EXPECT_TRUE(set.empty());
  EXPECT_EQ(scene.hash(), before);
}

TEST(EditApply, ABatchThatEndsWhereItBeganChangesNothing) {
  Scene scene = smallScene();
  const ChangeSet set =
      applied(scene, {SetMaterial{.material = 0, .roughness = 0.2f}, SetMaterial{.material = 0, .roughness = 1.0f},
                      SetNodeTransform{.node = 0, .translation = glm::dvec3(1)},
                      SetNodeTransform{.node = 0, .translation = glm::dvec3(0)}});
  EXPECT_TRUE(set.empty());
}

TEST(EditApply, TheLaterEditOfAFieldWins) {
  Scene scene = smallScene();
  applied(scene, {SetLight{.light = 1, .intensity = 5.0f}, SetLight{.light = 1, .intensity = 7.0f},
                  SetLight{.light = 1, .range = 2.0f}});
  EXPECT_EQ(scene.lights[1].intensity, 7.0f);
  EXPECT_EQ(scene.lights[1].range, 2.0f);
}

TEST(EditApply, EveryMaterialFieldIsWritten) {
  Scene scene = smallScene();
  const ChangeSet set = applied(scene, {SetMaterial{.material = 1,
                                                    .baseColor = glm::vec4(0.1f, 0.2f, 0.3f, 0.4f),
                                                    .metallic = 0.5f,
                                                    .roughness = 0.6f,
                                                    .emission = glm::vec3(1, 2, 3),
                                                    .ior = 1.2f,
                                                    .transmission = 0.7f,
                                                    .thickness = 0.8f,
                                                    .attenuationDistance = 0.9f,
                                                    .attenuationColor = glm::vec3(0.5f),
                                                    .specular = 0.3f,
                                                    .specularColor = glm::vec3(2),
                                                    .clearcoat = 0.4f,
                                                    .clearcoatRoughness = 0.1f,
                                                    .normalScale = -1.0f,
                                                    .alphaCutoff = 0.2f,
                                                    .alphaMode = AlphaMode::blend}});
  const Material& m = scene.materials[1];
  EXPECT_EQ(m.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.6f);
  EXPECT_EQ(m.emission, glm::vec3(1, 2, 3));
  EXPECT_EQ(m.ior, 1.2f);
  EXPECT_EQ(m.transmission, 0.7f);
  EXPECT_EQ(m.thickness, 0.8f);
  EXPECT_EQ(m.attenuationDistance, 0.9f);
  EXPECT_EQ(m.attenuationColor, glm::vec3(0.5f));
  EXPECT_EQ(m.specular, 0.3f);
  EXPECT_EQ(m.specularColor, glm::vec3(2));
  EXPECT_EQ(m.clearcoat, 0.4f);
  EXPECT_EQ(m.clearcoatRoughness, 0.1f);
  EXPECT_EQ(m.normalScale, -1.0f);
  EXPECT_EQ(m.alphaCutoff, 0.2f);
  EXPECT_EQ(m.alphaMode, AlphaMode::blend);
  EXPECT_EQ(set.materials, std::vector<uint32_t>{1});
  EXPECT_EQ(set.emissive, std::vector<uint32_t>{1});
}

TEST(EditApply, EachMaterialFieldAloneIsNoticed) {
  const SetMaterial edits[] = {{.baseColor = glm::vec4(0)},
                               {.metallic = 0.1f},
                               {.roughness = 0.1f},
                               {.emission = glm::vec3(1)},
                               {.ior = 1.1f},
                               {.transmission = 0.1f},
                               {.thickness = 0.1f},
                               {.attenuationDistance = 0.1f},
                               {.attenuationColor = glm::vec3(0)},
                               {.specular = 0.1f},
                               {.specularColor = glm::vec3(0)},
                               {.clearcoat = 0.1f},
                               {.clearcoatRoughness = 0.1f},
                               {.normalScale = 0.1f},
                               {.alphaCutoff = 0.1f},
                               {.alphaMode = AlphaMode::mask}};
  for (const SetMaterial& edit : edits) {
    Scene scene = smallScene();
    const uint64_t before = scene.hash();
    EXPECT_EQ(applied(scene, {edit}).materials, std::vector<uint32_t>{0}) << (&edit - edits);
    EXPECT_NE(scene.hash(), before) << (&edit - edits);
  }
}

TEST(EditApply, MovedNodesBringTheirDescendants) {
  Scene scene = smallScene();
  EXPECT_EQ(applied(scene, {SetNodeTransform{.node = 1, .translation = glm::dvec3(1)}}).nodes,
            (std::vector<uint32_t>{1, 2, 3}));
  EXPECT_EQ(applied(scene, {SetNodeTransform{.node = 3, .scale = glm::dvec3(2)},
                            SetNodeTransform{.node = 0, .scale = glm::dvec3(2)}})
                .nodes,
            (std::vector<uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(applied(scene, {SetNodeTransform{.node = 4, .scale = glm::dvec3(2)}}).nodes, std::vector<uint32_t>{4});
}

TEST(EditApply, RotationsAreNormalisedOnceAndForAll) {
  Scene scene = smallScene();
  applied(scene, {SetNodeTransform{.node = 4, .rotation = glm::dquat(0.3, 0.4, 0.5, 0.6)}});
  const glm::dquat q = scene.nodes[4].parentFromLocal.rotation;
  EXPECT_NEAR(glm::length(q), 1.0, 1e-15);
  EXPECT_TRUE(applied(scene, {SetNodeTransform{.node = 4, .rotation = q}}).empty());
  EXPECT_TRUE(applied(scene, {SetNodeTransform{.node = 4, .rotation = glm::dquat(0.3, 0.4, 0.5, 0.6)}}).empty());
}

TEST(EditApply, AShearedNodeKeepsItsShearWhenMovedAndLosesItWhenTurned) {
  Scene scene = smallScene();
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.5;
  scene.nodes[4].parentFromLocal.matrix = shear;
  applied(scene, {SetNodeTransform{.node = 4, .translation = glm::dvec3(1, 2, 3)}});
  shear[3] = glm::dvec4(1, 2, 3, 1);
  EXPECT_EQ(scene.nodes[4].parentFromLocal.toMatrix(), shear);
  EXPECT_EQ(applied(scene, {SetNodeTransform{.node = 4, .scale = glm::dvec3(2)}}).nodes, std::vector<uint32_t>{4});
  EXPECT_EQ(glm::dvec3(scene.worldFromNodes()[4] * glm::dvec4(1, 1, 1, 1)), glm::dvec3(3, 4, 5));
}

TEST(EditApply, HistoryLeavesNoTrace) {
  Scene direct = smallScene(), detour = smallScene();
  const std::vector<Edit> final = {SetMaterial{.material = 0, .roughness = 0.3f},
                                   SetNodeTransform{.node = 2, .rotation = glm::dquat(0.3, 0.4, 0.5, 0.6)},
                                   SetEnvironment{.radiance = glm::vec3(0.0f)},
                                   SetLight{.light = 0, .color = glm::vec3(0, 1, 0)}};
  applied(direct, final);
  applied(detour, {SetMaterial{.material = 0, .metallic = 0.2f, .roughness = 0.9f},
                   SetNodeTransform{.node = 2, .rotation = glm::dquat(0, 0, 1, 0)}});
  applied(detour, {SetEnvironment{.radiance = glm::vec3(5)}, SetLight{.light = 0, .color = glm::vec3(1, 0, 0)}});
  applied(detour, {SetMaterial{.material = 0, .metallic = 1.0f}, SetEnvironment{.radiance = glm::vec3(-0.0f)}});
  applied(detour, final);
  EXPECT_EQ(direct.hash(), detour.hash());
}

TEST(EditApply, AnEnvironmentImageIsComparedByItsTexels) {
  const auto sky = [](const std::string& name, float value) {
    Image image;
    image.name = name;
    image.width = image.height = 1;
    image.rgbaF = {value, value, value, 1.0f};
    return std::make_shared<const Image>(std::move(image));
  };
  Scene scene = smallScene();
  const uint64_t without = scene.hash();
  const auto set = [&](std::shared_ptr<const Image> image) {
    return applied(scene, {SetEnvironment{.image = std::move(image)}});
  };
  const ChangeSet first = set(sky("a", 1.0f));
  EXPECT_TRUE(first.environment && first.environmentImage);
  EXPECT_EQ(first.cost(), CostClass::relight);
  EXPECT_TRUE(set(sky("a", 1.0f)).empty());
  EXPECT_TRUE(applied(scene, {SetEnvironment{.rotation = 0.0f}}).empty());
  const uint64_t with = scene.hash();
  EXPECT_TRUE(set(sky("a", 2.0f)).environmentImage);
  EXPECT_TRUE(set(sky("b", 2.0f)).environmentImage);
  EXPECT_NE(with, scene.hash());
  EXPECT_NE(with, without);
  const ChangeSet turned = applied(scene, {SetEnvironment{.rotation = 1.0f}, SetEnvironment{.rotation = 2.0f}});
  EXPECT_TRUE(turned.environment && !turned.environmentImage);
  EXPECT_TRUE(applied(scene, {SetEnvironment{.rotation = 0.0f, .image = nullptr}}).environmentImage);
  EXPECT_EQ(scene.environment.image, nullptr);
  EXPECT_EQ(scene.hash(), without);
  EXPECT_TRUE(set(nullptr).empty());
}

TEST(EditCost, DearestChangeCounts) {
  const auto cost = [](const std::vector<Edit>& edits) {
    Scene scene = smallScene();
    return applied(scene, edits).cost();
  };
  const Edit exposure = SetResolve{.exposure = 1.0f}, toneMap = SetResolve{.toneMap = ToneMap::agx};
  const Edit light = SetLight{.light = 0, .intensity = 2.0f}, environment = SetEnvironment{.rotation = 1.0f};
  const Edit material = SetMaterial{.material = 0, .roughness = 0.5f}, view = viewEdit({0, 0, 5}, {0, 0, 0});
  const Edit move = SetNodeTransform{.node = 0, .translation = glm::dvec3(1)};
  EXPECT_EQ(cost({exposure}), CostClass::displayOnly);
  EXPECT_EQ(cost({toneMap}), CostClass::displayOnly);
  EXPECT_EQ(cost({light, exposure}), CostClass::relight);
  EXPECT_EQ(cost({environment}), CostClass::relight);
  EXPECT_EQ(cost({material, light}), CostClass::regather);
  EXPECT_EQ(cost({view}), CostClass::regather);
  EXPECT_EQ(cost({move, material, view}), CostClass::rebuild);
  ChangeSet reload;
  reload.everything = true;
  EXPECT_EQ(reload.cost(), CostClass::reload);
  EXPECT_STREQ(costClassName(CostClass::displayOnly), "display-only");
  EXPECT_STREQ(costClassName(CostClass::regather), "re-gather");
}

TEST(EditCost, ToneMapNamesGoBothWays) {
  for (const ToneMap map : {ToneMap::pbrNeutral, ToneMap::aces, ToneMap::agx, ToneMap::linear}) {
    EXPECT_EQ(toneMapFromName(toneMapName(map)), map);
  }
  EXPECT_FALSE(toneMapFromName("filmic").has_value());
}

TEST(EditCost, ViewNamesGoBothWays) {
  for (uint32_t i = 0; i <= uint32_t(ResolveView::placement); ++i) {
    EXPECT_EQ(resolveViewFromName(resolveViewName(ResolveView(i))), ResolveView(i));
  }
  EXPECT_STREQ(resolveViewName(ResolveView::indirect), "indirect");
  EXPECT_FALSE(resolveViewFromName("camera").has_value());
}

TEST(EditValidate, IndicesOutOfRange) {
  EXPECT_EQ(complaint(SetMaterial{.material = 2}), "material");
  EXPECT_EQ(complaint(SetLight{.light = 2}), "light");
  EXPECT_EQ(complaint(SetNodeTransform{.node = 5}), "node");
}

TEST(EditValidate, MaterialRanges) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(complaint(SetMaterial{.baseColor = glm::vec4(0, 0, 0, 1.1f)}), "baseColor");
  EXPECT_EQ(complaint(SetMaterial{.metallic = -0.1f}), "metallic");
  EXPECT_EQ(complaint(SetMaterial{.roughness = nan}), "roughness");
  EXPECT_EQ(complaint(SetMaterial{.emission = glm::vec3(0, inf, 0)}), "emission");
  EXPECT_EQ(complaint(SetMaterial{.ior = 0.9f}), "ior");
  EXPECT_EQ(complaint(SetMaterial{.ior = 0.0f}), "");
  EXPECT_EQ(complaint(SetMaterial{.transmission = 2.0f}), "transmission");
  EXPECT_EQ(complaint(SetMaterial{.thickness = -1.0f}), "thickness");
  EXPECT_EQ(complaint(SetMaterial{.attenuationDistance = inf}), "attenuationDistance");
  EXPECT_EQ(complaint(SetMaterial{.attenuationColor = glm::vec3(2)}), "attenuationColor");
  EXPECT_EQ(complaint(SetMaterial{.specular = 1.01f}), "specular");
  EXPECT_EQ(complaint(SetMaterial{.specularColor = glm::vec3(-1)}), "specularColor");
  EXPECT_EQ(complaint(SetMaterial{.clearcoat = 1.01f}), "clearcoat");
  EXPECT_EQ(complaint(SetMaterial{.clearcoatRoughness = 1.01f}), "clearcoatRoughness");
  EXPECT_EQ(complaint(SetMaterial{.normalScale = nan}), "normalScale");
  EXPECT_EQ(complaint(SetMaterial{.alphaCutoff = -0.1f}), "alphaCutoff");
  EXPECT_EQ(complaint(SetMaterial{.alphaMode = AlphaMode(7)}), "alphaMode");
  EXPECT_EQ(complaint(SetMaterial{.baseColor = glm::vec4(1), .metallic = 0.0f, .roughness = 1.0f}), "");
}

TEST(EditValidate, LightRanges) {
  EXPECT_EQ(complaint(SetLight{.color = glm::vec3(1.5f)}), "color");
  EXPECT_EQ(complaint(SetLight{.intensity = -1.0f}), "intensity");
  EXPECT_EQ(complaint(SetLight{.range = -1.0f}), "range");
  EXPECT_EQ(complaint(SetLight{.outerConeAngle = 1.6f}), "outerConeAngle");
  EXPECT_EQ(complaint(SetLight{.innerConeAngle = 0.8f}), "innerConeAngle");  // the present outer angle is pi/4
  EXPECT_EQ(complaint(SetLight{.innerConeAngle = 0.8f, .outerConeAngle = 0.9f}), "");
  EXPECT_EQ(complaint(SetLight{.outerConeAngle = 0.0f}), "outerConeAngle");
}

TEST(EditValidate, AnEditOfABatchIsJudgedByWhatTheOnesBeforeItLeave) {
  const Scene scene = smallScene();  // cones from 0 to pi/4
  const auto complaintOf = [&](const std::vector<Edit>& batch, size_t index) {
    const Result<void> result = validate(scene, batch, index);
    return result ? std::string() : result.error().place;
  };
  const Edit widen = SetLight{.light = 1, .outerConeAngle = 0.9f}, narrow = SetLight{.light = 1, .outerConeAngle = 0.3f},
             inner = SetLight{.light = 1, .innerConeAngle = 0.8f}, some = SetLight{.light = 1, .innerConeAngle = 0.5f},
             otherLight = SetLight{.light = 0, .outerConeAngle = 0.9f};
  EXPECT_EQ(complaintOf({widen, inner}, 1), "");
  EXPECT_EQ(complaintOf({inner, widen}, 0), "innerConeAngle") << "the order counts";
  EXPECT_EQ(complaintOf({some}, 0), "");
  EXPECT_EQ(complaintOf({narrow, some}, 1), "innerConeAngle") << "each alone is good, together they cross";
  EXPECT_EQ(complaintOf({some, narrow}, 1), "outerConeAngle");
  EXPECT_EQ(complaintOf({some, narrow}, 0), "");
  EXPECT_EQ(complaintOf({otherLight, inner}, 1), "innerConeAngle") << "another light's cone is another light's";
  EXPECT_EQ(complaintOf({narrow, widen, inner}, 2), "") << "the last one before it counts";
}

TEST(EditValidate, NodeRanges) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(SetNodeTransform{.translation = glm::dvec3(0, nan, 0)}), "translation");
  EXPECT_EQ(complaint(SetNodeTransform{.translation = glm::dvec3(1e16, 0, 0)}), "translation");
  EXPECT_EQ(complaint(SetNodeTransform{.rotation = glm::dquat(0, 0, 0, 0)}), "rotation");
  EXPECT_EQ(complaint(SetNodeTransform{.rotation = glm::dquat(nan, 0, 0, 0)}), "rotation");
  EXPECT_EQ(complaint(SetNodeTransform{.scale = glm::dvec3(1, 0, 1)}), "scale");
  EXPECT_EQ(complaint(SetNodeTransform{.scale = glm::dvec3(-1, 1, 1)}), "");
}

TEST(EditValidate, TransformsOfAChainReachNoFartherTogetherThanASceneMay) {
  Scene scene = smallScene();  // 0 above 1 above 2 and 3; 4 alone
  Primitive triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 10, 0}};
  triangle.indices = {0, 1, 2};
  scene.meshes.push_back({"triangle", {triangle}});
  scene.nodes[3].mesh = 0;
  const auto complaintOf = [&](const std::vector<Edit>& batch) {
    const Result<void> result = validateReach(scene, batch);
    return result ? std::string() : result.error().place;
  };
  const auto grow = [](uint32_t node, double scale) { return SetNodeTransform{.node = node, .scale = glm::dvec3(scale)}; };
  const Edit huge = grow(0, 1e12), lesser = grow(1, 1e2), tooMuch = grow(1, 1e4), other = grow(4, 1e12), dim = SetLight{.intensity = 0.5f};
  EXPECT_EQ(complaintOf({}), "");
  EXPECT_EQ(complaintOf({dim, huge, other}), "") << "far apart, one is as large as the other";
  EXPECT_EQ(complaintOf({huge, lesser}), "") << "ten metres of a mesh are 1e15 then";
  EXPECT_EQ(complaintOf({huge, dim, tooMuch}), "/edits/2");
  EXPECT_EQ(complaintOf({tooMuch, huge}), "/edits/0") << "the nearest one above the node";
  EXPECT_EQ(complaintOf({huge, grow(3, 1e3)}), "/edits/1") << "the mesh, of a node that is in reach itself";
  EXPECT_EQ(complaintOf({huge, grow(2, 1e3)}), "") << "a node without one";
  EXPECT_EQ(complaintOf({huge, tooMuch, lesser}), "") << "as the whole batch leaves it";
  EXPECT_EQ(complaintOf({huge, SetNodeTransform{.node = 1, .translation = glm::dvec3(0, 0, 1e4)}}), "/edits/1");
  scene.nodes[1].parentFromLocal.scale = glm::dvec3(1e12);
  EXPECT_EQ(complaintOf({grow(4, 2.0)}), "") << "what does not move is not asked about";
  EXPECT_EQ(complaintOf({grow(0, 1e4)}), "/edits/0") << "a child that moves along";
}

TEST(EditValidate, EnvironmentViewAndResolve) {
  EXPECT_EQ(complaint(SetEnvironment{.radiance = glm::vec3(-1)}), "radiance");
  EXPECT_EQ(complaint(SetEnvironment{.rotation = std::numeric_limits<float>::infinity()}), "rotation");
  EXPECT_EQ(complaint(viewEdit({0, 0, 0}, {0, 0, 0})), "view/target");
  EXPECT_EQ(complaint(viewEdit({0, 0, 1}, {0, 0, 0}, {0, 0, 2})), "view/up");
  EXPECT_EQ(complaint(viewEdit({NAN, 0, 1}, {0, 0, 0})), "view/eye");
  EXPECT_EQ(complaint(viewEdit({0, 0, 1}, {0, 0, 0})), "");
  SetView lens = viewEdit({0, 0, 1}, {0, 0, 0});
  lens.view.lens.yfov = 3.2f;
  EXPECT_EQ(complaint(lens), "view/yfov");
  lens.view.lens.perspective = false;
  EXPECT_EQ(complaint(lens), "");
  lens.view.lens.ymag = 0.0f;
  EXPECT_EQ(complaint(lens), "view/ymag");
  EXPECT_EQ(complaint(SetResolve{.exposure = 100.0f}), "exposure");
  EXPECT_EQ(complaint(SetResolve{.toneMap = ToneMap(9)}), "toneMap");
  EXPECT_EQ(complaint(SetResolve{.view = ResolveView(8)}), "view");
}

}  // namespace
}  // namespace limn
