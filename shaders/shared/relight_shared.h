// Lighting of surface points, as C++ and GLSL see it. [IPP §4]
#ifndef LIMN_RELIGHT_SHARED_H
#define LIMN_RELIGHT_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

// Reflectance at normal incidence from which a point keeps glossy lobes. What reflects less, a plain dielectric, reflects
// as if it were diffuse: its highlights are a twentieth of its light.
LIMN_CONST_FLOAT(kLobeReflectance, 0.1f);

// Next-event samples that one dispatch may take of a point: a ray takes up to 300 loop turns, and lavapipe ends an
// invocation's loops after 65,535.
LIMN_CONST_UINT(kRelightSamplesMost, 64u);

// The slots [firstSlot, firstSlot + slotCount) of every cluster.
struct RelightPush {
  uint firstSlot;
  uint slotCount;
  uint clusterCount;
  uint clusterSize;    // points a cluster
  uint samples;        // next-event samples a point takes now
  uint samplesBefore;  // and those that its means hold already; 0: they hold nothing yet
  uint seed;
  uint lobes;          // 1: there is room for glossy lobes
  uint lobeLights;     // lights at the head of the table that own a lobe each; samples of others share the rest
};
LIMN_ASSERT_SIZE(RelightPush, 36);

// Paths that one dispatch may take of a side: they take up to 15,000 loop turns each, see kRelightSamplesMost.
LIMN_CONST_UINT(kPathsMost, 4u);
// Paths without light after which a side of a point is dark.
LIMN_CONST_UINT(kPathsToBelieveDark, 16u);

// Paths from both sides of the slots [firstSlot, firstSlot + slotCount) of every cluster.
struct TracePointsPush {
  uint firstSlot;
  uint slotCount;
  uint clusterCount;
  uint clusterSize;    // points a cluster
  uint samples;        // paths a side takes now
  uint samplesBefore;  // and those that its mean holds already; 0: it holds nothing yet
  uint seed;
  uint bounces;        // that reach the point; at least 1
};
LIMN_ASSERT_SIZE(TracePointsPush, 32);

struct ComposePush {
  uint firstSlot;
  uint slotCount;
  uint clusterCount;
  uint clusterSize;
  uint lobes;
};
LIMN_ASSERT_SIZE(ComposePush, 20);

struct SpreadPush {
  uint firstSlot;
  uint slotCount;
  uint clusterCount;
  uint clusterSize;
};
LIMN_ASSERT_SIZE(SpreadPush, 16);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
