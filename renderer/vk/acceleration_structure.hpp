#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "renderer/vk/buffer.hpp"

namespace limn::vk {

/// Triangles for a bottom-level structure, read once while it is built. Buffers have BufferUsage::accelerationInput.
struct TriangleGeometry {
  const Buffer* positions = nullptr;  ///< three floats each, object space
  size_t positionsOffset = 0;         ///< bytes
  size_t positionStride = 12;         ///< bytes, a multiple of 4
  uint32_t vertexCount = 0;
  const Buffer* indices = nullptr;    ///< uint32, three a triangle
  size_t indicesOffset = 0;           ///< bytes
  uint32_t triangleCount = 0;
  bool opaque = true;                 ///< false: the shader confirms each hit (alpha)
};

class AccelerationStructure;

/// One placed bottom-level structure.
struct AccelerationInstance {
  std::array<float, 12> worldFromObject{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< 3x4, row after row
  uint32_t customIndex = 0;  ///< 24 bits; rayQueryGetIntersectionInstanceCustomIndexEXT
  uint8_t mask = 0xff;
  const AccelerationStructure* geometry = nullptr;
};

/// Triangles or placed instances in the device's own tree, for ray queries (BindingKind::acceleration). Building
/// waits for the device. A structure of instances needs its geometries alive while it is traced. Render thread.
class AccelerationStructure {
 public:
  /// One geometry for each entry; hits tell the entry by geometry index. Errors: "unsupported" without ray queries,
  /// "limit", "out-of-memory", "device-lost".
  static Result<AccelerationStructure> fromTriangles(Device& device, std::span<const TriangleGeometry> geometries,
                                                     const std::string& name, const std::string& owner);
  /// Errors as above.
  static Result<AccelerationStructure> fromInstances(Device& device, std::span<const AccelerationInstance> instances,
                                                     const std::string& name, const std::string& owner);

  AccelerationStructure() = default;
  ~AccelerationStructure();
  AccelerationStructure(AccelerationStructure&& other) noexcept;
  AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

  explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
  VkAccelerationStructureKHR handle() const { return m_handle; }
  VkDeviceAddress address() const { return m_address; }
  uint64_t bytes() const { return m_storage.size(); }

 private:
  /// Sizes, allocates and builds; `counts` has the primitives of each geometry.
  Result<void> build(VkAccelerationStructureTypeKHR type,
                     std::span<const VkAccelerationStructureGeometryKHR> geometries, std::span<const uint32_t> counts,
                     const std::string& name, const std::string& owner);
  void destroy();

  Device* m_device = nullptr;
  Buffer m_storage;
  VkAccelerationStructureKHR m_handle = VK_NULL_HANDLE;
  VkDeviceAddress m_address = 0;
};

}  // namespace limn::vk
