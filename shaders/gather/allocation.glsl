// How many samples each cluster is given. One invocation runs allocate(), between barriers.
#ifndef LIMN_ALLOCATION_GLSL
#define LIMN_ALLOCATION_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/sampling.glsl"

const uint kMostClusters = 1024u, kMostSamples = 4096u;
const uint kSampleBits = 12u, kSampleMask = kMostSamples - 1u;

shared float importance[kMostClusters];  // >= 0, finite
shared uint clusterRun[kMostClusters];   // random bits; then first sample of the cluster | random slot << kSampleBits

// One of `slots` by random bits.
uint slotOf(uint bits, uint slots) { return remainderOf(bits & 0x3fffffu, slots); }

// Shares out exactly `samples` samples: what one cluster is given too much or too little, the next one settles.
// Afterwards importance[] holds the expected number of samples. `sum` is that of importance[]. [IPP §3.2]
void allocate(uint samples, uint clusters, uint slots, float sum) {
  bool blind = !(sum > 1e-30);  // no cluster matters more than another
  float perImportance = float(samples) / (blind ? float(clusters) : sum), carry = 0.0;
  uint given = 0u;
  for (uint k = 0u; k < clusters; ++k) {
    uint bits = clusterRun[k];
    float expected = (blind ? 1.0 : importance[k]) * perImportance;
    importance[k] = expected;
    float wanted = expected + carry;
    uint count = uint(max(wanted, 0.0));
    wanted -= float(count);
    bool more = toUnit(bits) < wanted;
    count += more ? 1u : 0u;
    carry = more ? wanted - 1.0 : wanted;
    // Rounding may leave one too many or too few; it is the last cluster's.
    count = k + 1u == clusters ? samples - given : min(count, samples - given);
    clusterRun[k] = given | slotOf(bits, slots) << kSampleBits;
    given += count;
  }
}

uint firstSample(uint cluster) { return clusterRun[cluster] & kSampleMask; }

#endif
