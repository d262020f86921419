#include "renderer/vk/acceleration_structure.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "renderer/vk/command_recorder.hpp"
#include "renderer/vk/transfer.hpp"

namespace limn::vk {
namespace {

Error noRayQuery(const Device& device) {
  return {"unsupported", device.info().name + " has no ray queries, so no acceleration structures", ""};
}

VkAccelerationStructureGeometryKHR describe(const TriangleGeometry& geometry) {
  LIMN_CHECK(geometry.positions && geometry.indices && geometry.vertexCount > 0);
  LIMN_CHECK_EQ(geometry.positionStride % 4, 0u);
  LIMN_CHECK_LE(geometry.positionsOffset + geometry.positionStride * (geometry.vertexCount - 1) + 12,
                geometry.positions->size());
  LIMN_CHECK_LE(geometry.indicesOffset + size_t(12) * geometry.triangleCount, geometry.indices->size());
  auto described = typed<VkAccelerationStructureGeometryKHR>(VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR);
  described.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
  described.flags = geometry.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
  described.geometry.triangles = typed<VkAccelerationStructureGeometryTrianglesDataKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR);
  auto& triangles = described.geometry.triangles;
  triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
  triangles.vertexData.deviceAddress = geometry.positions->address() + geometry.positionsOffset;
  triangles.vertexStride = geometry.positionStride;
  triangles.maxVertex = geometry.vertexCount - 1;
  triangles.indexType = VK_INDEX_TYPE_UINT32;
  triangles.indexData.deviceAddress = geometry.indices->address() + geometry.indicesOffset;
  return described;
}

VkAccelerationStructureInstanceKHR describe(const AccelerationInstance& instance) {
  LIMN_CHECK(instance.geometry && *instance.geometry);
  LIMN_CHECK_LE(instance.customIndex, 0xffffffu);
  VkAccelerationStructureInstanceKHR described{};
  std::memcpy(&described.transform, instance.worldFromObject.data(), sizeof described.transform);
  described.instanceCustomIndex = instance.customIndex & 0xffffffu;
  described.mask = instance.mask;
  described.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
  described.accelerationStructureReference = instance.geometry->address();
  return described;
}

uint64_t scratchAlignment(const Device& device) {
  auto acceleration = typed<VkPhysicalDeviceAccelerationStructurePropertiesKHR>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR);
  auto properties = typed<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  properties.pNext = &acceleration;
  vkGetPhysicalDeviceProperties2(device.physical(), &properties);
  return std::max<uint64_t>(1, acceleration.minAccelerationStructureScratchOffsetAlignment);
}

Result<Buffer> createBuffer(Device& device, size_t size, BufferUsage usage, const std::string& name,
                            const std::string& owner) {
  BufferDesc desc;
  desc.size = size;
  desc.usage = usage;
  desc.name = name;
  desc.owner = owner;
  return Buffer::create(device, desc);
}

}  // namespace

Result<AccelerationStructure> AccelerationStructure::fromTriangles(Device& device,
                                                                   std::span<const TriangleGeometry> geometries,
                                                                   const std::string& name, const std::string& owner) {
  if (!device.hasRayQuery()) return noRayQuery(device);
  std::vector<VkAccelerationStructureGeometryKHR> described;
  std::vector<uint32_t> counts;
  for (const TriangleGeometry& geometry : geometries) {
    described.push_back(describe(geometry));
    counts.push_back(geometry.triangleCount);
  }
  AccelerationStructure structure;
  structure.m_device = &device;
  auto built = structure.build(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, described, counts, name, owner);
  if (!built) return built.error();
  return structure;
}

Result<AccelerationStructure> AccelerationStructure::fromInstances(Device& device,
                                                                   std::span<const AccelerationInstance> instances,
                                                                   const std::string& name, const std::string& owner) {
  if (!device.hasRayQuery()) return noRayQuery(device);
  std::vector<VkAccelerationStructureInstanceKHR> described;
  for (const AccelerationInstance& instance : instances) described.push_back(describe(instance));
  described.resize(std::max<size_t>(1, described.size()));  // an empty scene still needs an address to name
  auto buffer = createBuffer(device, described.size() * sizeof described[0], BufferUsage::accelerationInput,
                             name + ".instances", owner);
  if (!buffer) return buffer.error();
  if (auto done = uploadArray<VkAccelerationStructureInstanceKHR>(device, *buffer, described); !done) {
    return done.error();
  }
  auto geometry = typed<VkAccelerationStructureGeometryKHR>(VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR);
  geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry.geometry.instances = typed<VkAccelerationStructureGeometryInstancesDataKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR);
  geometry.geometry.instances.data.deviceAddress = buffer->address();

  AccelerationStructure structure;
  structure.m_device = &device;
  const uint32_t count = uint32_t(instances.size());
  auto built = structure.build(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, {&geometry, 1}, {&count, 1}, name, owner);
  if (!built) return built.error();
  return structure;
}

Result<void> AccelerationStructure::build(VkAccelerationStructureTypeKHR type,
                                          std::span<const VkAccelerationStructureGeometryKHR> geometries,
                                          std::span<const uint32_t> counts, const std::string& name,
                                          const std::string& owner) {
  const DeviceFunctions& functions = m_device->functions();
  auto info = typed<VkAccelerationStructureBuildGeometryInfoKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR);
  info.type = type;
  info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
  info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
  info.geometryCount = uint32_t(geometries.size());
  info.pGeometries = geometries.data();
  auto sizes = typed<VkAccelerationStructureBuildSizesInfoKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR);
  functions.getAccelerationStructureBuildSizes(
      m_device->handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, counts.data(), &sizes);

  // Room for the tree, and for the work on it.
  auto storage =
      createBuffer(*m_device, sizes.accelerationStructureSize, BufferUsage::accelerationStorage, name, owner);
  if (!storage) return storage.error();
  m_storage = storage.take();
  const uint64_t alignment = scratchAlignment(*m_device);
  const size_t scratchBytes = std::max<size_t>(4, sizes.buildScratchSize) + alignment;
  const auto scratch = createBuffer(*m_device, scratchBytes, BufferUsage::scratch, name + ".scratch", owner);
  if (!scratch) return scratch.error();
  auto create = typed<VkAccelerationStructureCreateInfoKHR>(VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR);
  create.buffer = m_storage.handle();
  create.size = sizes.accelerationStructureSize;
  create.type = type;
  const VkResult r = functions.createAccelerationStructure(m_device->handle(), &create, nullptr, &m_handle);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateAccelerationStructureKHR for " + name);
  m_device->setName(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, uint64_t(m_handle), name);

  // Build it now.
  info.dstAccelerationStructure = m_handle;
  info.scratchData.deviceAddress = (scratch->address() + alignment - 1) / alignment * alignment;
  std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
  for (const uint32_t count : counts) ranges.push_back({count, 0, 0, 0});
  const VkAccelerationStructureBuildRangeInfoKHR* firstRange = ranges.data();
  CommandRecorder recorder(*m_device);
  recorder.begin();
  if (recorder.handle()) functions.cmdBuildAccelerationStructures(recorder.handle(), 1, &info, &firstRange);
  if (auto done = submitAndWait(*m_device, recorder); !done) return done.error();
  auto addressInfo = typed<VkAccelerationStructureDeviceAddressInfoKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR);
  addressInfo.accelerationStructure = m_handle;
  m_address = functions.getAccelerationStructureDeviceAddress(m_device->handle(), &addressInfo);
  return {};
}

AccelerationStructure::~AccelerationStructure() { destroy(); }

AccelerationStructure::AccelerationStructure(AccelerationStructure&& other) noexcept { *this = std::move(other); }

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  m_device = std::exchange(other.m_device, nullptr);
  m_storage = std::move(other.m_storage);
  m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
  m_address = std::exchange(other.m_address, 0);
  return *this;
}

void AccelerationStructure::destroy() {
  if (!m_handle) return;
  m_device->retire([device = m_device, handle = m_handle] {
    device->functions().destroyAccelerationStructure(device->handle(), handle, nullptr);
  });
  m_handle = VK_NULL_HANDLE;
}

}  // namespace limn::vk
