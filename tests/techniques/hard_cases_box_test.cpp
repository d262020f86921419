// The Cornell box made awkward in one way each (tests/scenes/scenes_hard.py): the picture stays the same.
#include "tests/techniques/hard_cases.hpp"

namespace limn::test {
namespace {

HardCase boxCase(const std::string& name, const std::string& claim, const std::string& file,
                 const std::string& twin = "cornell-point") {
  HardCase hard = hardCase(name, claim, [file] { return generatedScene(file); });
  hard.twinName = twin;
  hard.twin = [twin] { return generatedScene(twin); };
  return hard;
}

}  // namespace

std::vector<HardCase> makeHardCases() {
  std::vector<HardCase> cases{
      boxCase("scale 1e-3", "A thousandth of the size, intensity by its square", "hard-scale-1e-3"),
      boxCase("scale 1e4", "Ten thousand times the size, intensity by its square", "hard-scale-1e4"),
      boxCase("far by node", "1e5 m away by the root node", "hard-far-node"),
      boxCase("far baked", "1e5 m away in its vertices, whose digits are 1/700 of the box apart", "hard-far-baked"),
      boxCase("rotated", "Turned about an odd axis, camera and light included", "hard-rotated"),
      boxCase("permuted", "Triangles and vertices in another order", "hard-permuted"),
      boxCase("split emitters", "The lamp as 128 triangles of unequal size", "hard-split-emitters", "cornell-box"),
      boxCase("doubled vertices", "Every vertex stored twice", "hard-doubled-vertices"),
      boxCase("coplanar duplicates", "Every triangle twice in the same place", "hard-coplanar"),
      boxCase("zero-area triangles", "Triangles without area and needles 1e-7 m wide", "hard-degenerate"),
      boxCase("bad normals", "Normals of length 0, 3, 1e-12 and 1e12", "hard-bad-normals"),
      boxCase("mirrored nodes", "Mirrored vertices, mirrored back by a node", "hard-mirrored")};
  // Corners that move by half a digit move edges by a twentieth of a pixel.
  cases[3].rounding = 5e-3;
  return cases;
}

const char* hardCaseGroup() { return "1-box"; }

}  // namespace limn::test
