#include "renderer/gpu/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "renderer/base/check.hpp"

namespace limn::gpu {
namespace {

constexpr double kPi = std::numbers::pi;
// What the shader's floats round: lengths, and angles whose cosine is near 1 [rad].
constexpr double kSlack = 1e-6, kAngleSlack = 5e-4;

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The cone around both, their axes turned the same way where they are two-sided.
void mergeCones(LightBounds& a, LightBounds b) {
  if (a.cosEnd != b.cosEnd) {
    a.opening = kPi;
    return;
  }
  if (a.cosEnd == shared::kTwoSidedEnd && glm::dot(a.axis, b.axis) < 0.0) b.axis = -b.axis;
  const double between = angleBetween(a.axis, b.axis);
  if (between + b.opening <= a.opening) return;
  if (between + a.opening <= b.opening) {
    a.axis = b.axis;
    a.opening = b.opening;
    return;
  }
  const double opening = 0.5 * (a.opening + between + b.opening), turned = opening - a.opening;
  const glm::dvec3 across = b.axis - a.axis * glm::dot(a.axis, b.axis);
  const double length = glm::length(across);
  if (opening >= kPi || !(length > 0.0)) {
    a.opening = kPi;
    return;
  }
  a.axis = glm::normalize(a.axis * std::cos(turned) + across * (std::sin(turned) / length));
  a.opening = opening;
}

LightBounds merged(LightBounds a, const LightBounds& b) {
  a.low = glm::min(a.low, b.low);
  a.high = glm::max(a.high, b.high);
  a.intensity += b.intensity;
  mergeCones(a, b);
  return a;
}

shared::LightNode nodeOf(const LightBounds& b, uint32_t child, uint32_t parent) {
  shared::LightNode node{};
  node.centerR = glm::vec3(0.5 * (glm::dvec3(b.low) + glm::dvec3(b.high)));
  if (b.low != b.high) {
    const glm::dvec3 center(node.centerR);
    const double reach = glm::length(glm::max(glm::dvec3(b.high) - center, center - glm::dvec3(b.low)));
    node.radius = float(reach * (1.0 + kSlack));
  }
  node.axis = glm::vec3(b.axis);
  node.cosOpening = b.opening >= kPi ? -1.0f : float(std::cos(std::min(b.opening + kAngleSlack, kPi)));
  node.intensity = float(std::clamp(b.intensity, 1e-30, 1e30));
  node.cosEnd = b.cosEnd;
  node.child = child;
  node.parent = parent;
  return node;
}

/// Lights that fall into one slice of a branch.
struct Bin {
  glm::dvec3 low{0.0}, high{0.0};
  double intensity = 0.0;
  size_t count = 0;

  void add(const glm::dvec3& l, const glm::dvec3& h, double i, size_t n) {
    if (n == 0) return;
    low = count ? glm::min(low, l) : l;
    high = count ? glm::max(high, h) : h;
    intensity += i;
    count += n;
  }
  void add(const Bin& b) { add(b.low, b.high, b.intensity, b.count); }
  double cost() const { return intensity * glm::dot(high - low, high - low); }
};

class Builder {
 public:
  explicit Builder(std::span<const LightBounds> lights) : m_lights(lights.begin(), lights.end()) {
    m_nodes.reserve(lightTreeNodes(lights.size()));
    split(0, m_lights.size(), shared::kNoIndex);
  }
  std::vector<shared::LightNode> take() { return std::move(m_nodes); }

 private:
  static constexpr size_t kBins = 16;

  /// Makes the two children of lights [first, end), and says what they hold together.
  LightBounds split(size_t first, size_t end, uint32_t parent) {
    const auto left = uint32_t(m_nodes.size());
    m_nodes.resize(m_nodes.size() + 2);
    const size_t middle = divide(first, end);
    const LightBounds a = fill(left, first, middle, parent), b = fill(left + 1, middle, end, parent);
    return merged(a, b);
  }

  LightBounds fill(uint32_t node, size_t first, size_t end, uint32_t parent) {
    const auto child = uint32_t(m_nodes.size());
    const bool leaf = end - first == 1;
    const LightBounds bounds = leaf ? m_lights[first] : split(first, end, node);
    m_nodes[node] = nodeOf(bounds, leaf ? shared::kLightLeaf | bounds.light : child, parent);
    return bounds;
  }

  /// Sorts [first, end) into two parts that both hold lights, and says where the second begins.
  size_t divide(size_t first, size_t end) {
    glm::dvec3 low = middleOf(m_lights[first]), high = low;
    for (size_t i = first; i < end; ++i) {
      low = glm::min(low, middleOf(m_lights[i]));
      high = glm::max(high, middleOf(m_lights[i]));
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    if (!(size[axis] > 0.0)) return first + (end - first) / 2;
    const auto binOf = [&](const LightBounds& b) {
      return std::min(size_t((middleOf(b)[axis] - low[axis]) / size[axis] * double(kBins)), kBins - 1);
    };
    std::array<Bin, kBins> bins;
    for (size_t i = first; i < end; ++i)
      bins[binOf(m_lights[i])].add(m_lights[i].low, m_lights[i].high, m_lights[i].intensity, 1);
    const size_t cut = bestCut(bins);
    const auto begin = m_lights.begin();
    const auto second = std::stable_partition(begin + ptrdiff_t(first), begin + ptrdiff_t(end),
                                              [&](const LightBounds& b) { return binOf(b) < cut; });
    return size_t(second - begin);
  }

  /// The first bin of the second part; the first and the last bin hold lights.
  static size_t bestCut(const std::array<Bin, kBins>& bins) {
    std::array<double, kBins> costBefore{};
    Bin sum;
    for (size_t i = 1; i < kBins; ++i) {
      sum.add(bins[i - 1]);
      costBefore[i] = sum.cost();
    }
    sum = {};
    size_t best = kBins - 1;
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = kBins - 1; i > 0; --i) {
      sum.add(bins[i]);
      if (const double cost = costBefore[i] + sum.cost(); cost < least) least = cost, best = i;
    }
    return best;
  }

  static glm::dvec3 middleOf(const LightBounds& b) { return 0.5 * (glm::dvec3(b.low) + glm::dvec3(b.high)); }

  std::vector<LightBounds> m_lights;
  std::vector<shared::LightNode> m_nodes;
};

}  // namespace

LightBounds pointBounds(const glm::vec3& posR, double intensity) {
  LightBounds bounds;
  bounds.low = bounds.high = posR;
  bounds.opening = kPi;
  bounds.intensity = intensity;
  return bounds;
}

LightBounds spotBounds(const glm::vec3& posR, const glm::vec3& dirR, float cosOuter, double intensity) {
  LightBounds bounds = pointBounds(posR, intensity);
  bounds.axis = glm::dvec3(dirR);
  bounds.opening = std::acos(std::clamp(double(cosOuter), -1.0, 1.0));
  bounds.cosEnd = shared::kSpotEnd;
  return bounds;
}

LightBounds triangleBounds(const glm::vec3* corner, double intensity) {
  LightBounds bounds;
  bounds.low = glm::min(corner[0], glm::min(corner[1], corner[2]));
  bounds.high = glm::max(corner[0], glm::max(corner[1], corner[2]));
  const glm::dvec3 a(corner[0]), normal = glm::cross(glm::dvec3(corner[1]) - a, glm::dvec3(corner[2]) - a);
  bounds.axis = normal / glm::length(normal);
  bounds.intensity = intensity;
  return bounds;
}

std::vector<shared::LightNode> buildLightTree(std::span<const LightBounds> lights) {
  LIMN_CHECK(lights.size() > 1);
  return Builder(lights).take();
}

}  // namespace limn::gpu
