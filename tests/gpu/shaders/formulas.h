#ifndef LIMN_TEST_FORMULAS_H
#define LIMN_TEST_FORMULAS_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kFormulaOctDecode, 0u);  // x: the packed word
LIMN_CONST_UINT(kFormulaFrame, 1u);      // xyz: a normal; gives the frame's largest error and its lengths
LIMN_CONST_UINT(kFormulaSrgb, 2u);
LIMN_CONST_UINT(kFormulaRemainder, 3u);  // the words x mod y, as a number
LIMN_CONST_UINT(kFormulaGgxAlbedo, 4u);  // x: cosine, y: alpha; gives both directional albedos and both means
LIMN_CONST_UINT(kFormulaToneMap, 5u);    // + limn::ToneMap

struct FormulasPush {
  uint formula;
  uint count;
};

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
