#include "renderer/scene/gltf_accessors.hpp"

#include <algorithm>
#include <cstring>

#include "renderer/scene/gltf_accessor_layout.hpp"

namespace limn::gltf {
namespace {

/// Where the elements of an accessor lie: checkBuffers has proved that all of them are inside.
struct Source {
  const uint8_t* bytes = nullptr;  ///< null: all zero
  size_t stride = 0;
};

Source sourceOf(const tinygltf::Model& model, int viewIndex, size_t offset, size_t packedStride, bool strided) {
  if (viewIndex < 0) return {};
  const tinygltf::BufferView& view = model.bufferViews[size_t(viewIndex)];
  const std::vector<unsigned char>& data = model.buffers[size_t(view.buffer)].data;
  return {data.data() + view.byteOffset + offset, strided && view.byteStride != 0 ? view.byteStride : packedStride};
}

template <class T>
T load(const uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class Stored, class Out, class Convert>
void copyElements(Source source, uint64_t count, uint32_t components, Out* out, Convert convert) {
  for (uint64_t i = 0; i < count; ++i) {
    const uint8_t* element = source.bytes + i * source.stride;
    for (uint32_t c = 0; c < components; ++c) *out++ = convert(load<Stored>(element + c * sizeof(Stored)));
  }
}

void toFloats(Source source, uint64_t count, uint32_t components, int componentType, bool normalized, float* out) {
  const auto scaled = [&](float largest) {
    return [=](auto v) { return normalized ? std::max(float(v) / largest, -1.0f) : float(v); };
  };
  switch (componentType) {
    case 5120: return copyElements<int8_t>(source, count, components, out, scaled(127.0f));
    case 5121: return copyElements<uint8_t>(source, count, components, out, scaled(255.0f));
    case 5122: return copyElements<int16_t>(source, count, components, out, scaled(32767.0f));
    case 5123: return copyElements<uint16_t>(source, count, components, out, scaled(65535.0f));
    case 5125: return copyElements<uint32_t>(source, count, components, out, scaled(4294967295.0f));
    default: return copyElements<float>(source, count, components, out, [](float v) { return v; });
  }
}

void toUnsigned(Source source, uint64_t count, uint32_t components, int componentType, uint32_t* out) {
  const auto same = [](auto v) { return uint32_t(v); };
  if (componentType == 5121) copyElements<uint8_t>(source, count, components, out, same);
  else if (componentType == 5123) copyElements<uint16_t>(source, count, components, out, same);
  else copyElements<uint32_t>(source, count, components, out, same);
}

/// The elements that the sparse part replaces: strictly increasing, all below the accessor's count.
std::vector<uint32_t> sparseTargets(const tinygltf::Model& model, const tinygltf::Accessor& accessor, int index) {
  const auto& sparse = accessor.sparse;
  const uint32_t bytes = componentBytes(uint64_t(sparse.indices.componentType));
  const Source source = sourceOf(model, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), bytes, false);
  std::vector<uint32_t> targets(size_t(sparse.count));
  toUnsigned(source, targets.size(), 1, sparse.indices.componentType, targets.data());
  const std::string pointer = pointerOf("accessors", index, "sparse", "indices");
  for (size_t i = 0; i < targets.size(); ++i) {
    if (targets[i] >= accessor.count) {
      fail("out-of-range",
           "sparse index " + std::to_string(i) + " is " + std::to_string(targets[i]) + ", there are " +
               std::to_string(accessor.count) + " elements",
           pointer);
    }
    if (i > 0 && targets[i] <= targets[i - 1]) fail("bad-file", "sparse indices must increase", pointer);
  }
  return targets;
}

template <class Out, class Read>
std::vector<Out> readAll(const Document& document, int index, uint32_t components, Read read) {
  const tinygltf::Accessor& accessor = document.model.accessors[size_t(index)];
  const size_t packed = size_t(components) * componentBytes(uint64_t(accessor.componentType));
  std::vector<Out> out(accessor.count * components, Out(0));
  const Source dense = sourceOf(document.model, accessor.bufferView, accessor.byteOffset, packed, true);
  if (dense.bytes) read(dense, accessor, accessor.count, out.data());
  if (!accessor.sparse.isSparse) return out;

  const std::vector<uint32_t> targets = sparseTargets(document.model, accessor, index);
  const Source values = sourceOf(document.model, accessor.sparse.values.bufferView,
                                 size_t(accessor.sparse.values.byteOffset), packed, false);
  std::vector<Out> replaced(targets.size() * components);
  read(values, accessor, targets.size(), replaced.data());
  for (size_t i = 0; i < targets.size(); ++i) {
    std::copy_n(replaced.begin() + std::ptrdiff_t(i * components), components,
                out.begin() + std::ptrdiff_t(size_t(targets[i]) * components));
  }
  return out;
}

}  // namespace

std::vector<float> readFloats(const Document& document, int index, uint32_t components, Integers integers) {
  return readAll<float>(
      document, index, components, [&](Source source, const tinygltf::Accessor& a, uint64_t count, float* out) {
        toFloats(source, count, components, a.componentType, a.normalized || integers == Integers::normalized, out);
      });
}

std::vector<uint32_t> readUnsigned(const Document& document, int index, uint32_t components) {
  return readAll<uint32_t>(document, index, components,
                           [&](Source source, const tinygltf::Accessor& a, uint64_t count, uint32_t* out) {
                             toUnsigned(source, count, components, a.componentType, out);
                           });
}

uint64_t countOf(const Document& document, int index) { return document.model.accessors[size_t(index)].count; }

}  // namespace limn::gltf
