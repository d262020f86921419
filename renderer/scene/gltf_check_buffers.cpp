#include "renderer/scene/gltf_accessor_layout.hpp"
#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {
namespace {

constexpr uint64_t kMaxOffset = (1ull << 31) - 1;  ///< tinygltf holds the offsets of sparse accessors in an int

/// Whether `count` elements of `size` bytes, `stride` apart, starting at `offset`, fit into `length` bytes.
bool fits(uint64_t offset, uint64_t count, uint64_t stride, uint64_t size, uint64_t length) {
  if (offset > length || size > length - offset) return false;
  return count == 0 || count - 1 <= (length - offset - size) / stride;
}

void checkView(const Value& view, const Value& buffers) {
  const Value buffer = view.need("buffer");
  const Value length = view.need("byteLength");
  const uint64_t total = buffers[buffer.asIndex(buffers.size(), "buffer")].need("byteLength").asUnsigned(1);
  const uint64_t offset = view.unsignedOr("byteOffset", 0);
  if (!fits(offset, 1, 1, length.asUnsigned(1), total)) {
    length.fail("out-of-range", "the view reaches beyond its buffer of " + std::to_string(total) + " bytes");
  }
  const uint64_t stride = view.unsignedOr("byteStride", 4, 4, 252);
  if (stride % 4 != 0) view.need("byteStride").fail("bad-file", "byteStride is not a multiple of 4");
}

struct Layout {
  uint32_t component = 0, element = 0;  ///< [byte]
};

Layout layoutOf(const Value& accessor) {
  const Value component = accessor.need("componentType"), type = accessor.need("type");
  const uint32_t bytes = componentBytes(component.asUnsigned());
  if (bytes == 0) component.fail("bad-file", "there is no such component type");
  const ElementShape shape = elementShape(type.asString());
  if (shape.rows == 0) type.fail("bad-file", "there is no such accessor type");
  return {bytes, elementBytes(shape, bytes)};
}

/// `count` elements of `size` bytes read from the view that `part` names must lie in it.
void checkReach(const Value& part, const Value& blame, const Value& views, uint64_t count, uint32_t size,
                uint32_t alignment, bool strided) {
  const Value view = views[part.need("bufferView").asIndex(views.size(), "bufferView")];
  const uint64_t offset = part.unsignedOr("byteOffset", 0);
  const uint64_t stride = strided ? view.unsignedOr("byteStride", size) : size;
  if (stride < size) view.need("byteStride").fail("bad-file", "byteStride is smaller than one element");
  const uint64_t length = view.need("byteLength").asUnsigned();
  if (!fits(offset, count, stride, size, length)) {
    blame.fail("out-of-range",
               std::to_string(count) + " elements reach beyond their view of " + std::to_string(length) + " bytes");
  }
  if ((offset + view.unsignedOr("byteOffset", 0)) % alignment != 0) {
    part.fail("bad-file", "the data do not start at a multiple of the component's size");
  }
}

void checkSparse(const Value& sparse, const Value& views, uint64_t accessorCount, const Layout& layout) {
  const Value count = sparse.need("count");
  const uint64_t replaced = count.asUnsigned(1);
  if (replaced > accessorCount) count.fail("out-of-range", "more elements are replaced than there are");
  const Value indices = sparse.need("indices"), values = sparse.need("values");
  const Value component = indices.need("componentType");
  const uint64_t type = component.asUnsigned();
  if (type != 5121 && type != 5123 && type != 5125) component.fail("bad-file", "indices must be unsigned integers");
  checkReach(indices, count, views, replaced, componentBytes(type), componentBytes(type), false);
  checkReach(values, count, views, replaced, layout.element, layout.component, false);
  indices.unsignedOr("byteOffset", 0, 0, kMaxOffset);
  values.unsignedOr("byteOffset", 0, 0, kMaxOffset);
}

void checkAccessor(const Value& accessor, const Value& views, const LoadLimits& limits) {
  const Layout layout = layoutOf(accessor);
  const Value count = accessor.need("count");
  const uint64_t elements = count.asUnsigned(1);
  if (accessor.has("bufferView")) {
    checkReach(accessor, count, views, elements, layout.element, layout.component, true);
  } else if (elements > limits.maxVertices) {
    count.fail("limit",
               std::to_string(elements) + " elements are more than the limit of " + std::to_string(limits.maxVertices));
  }
  accessor.boolOr("normalized", false);
  if (const auto sparse = accessor.find("sparse")) checkSparse(*sparse, views, elements, layout);
}

}  // namespace

void checkBuffers(const Document& document) {
  const Value root = document.root();
  const Value buffers = root.list("buffers"), views = root.list("bufferViews"), accessors = root.list("accessors");
  uint64_t total = 0;
  for (size_t i = 0; i < buffers.size(); ++i) {
    const Value length = buffers[i].need("byteLength");
    const uint64_t bytes = length.asUnsigned(1);
    if (bytes > document.limits.maxFileBytes || (total += bytes) > document.limits.maxFileBytes) {
      length.fail("limit", "the buffers hold more than " + std::to_string(document.limits.maxFileBytes) + " bytes");
    }
    buffers[i].stringOr("uri", "");
  }
  for (size_t i = 0; i < views.size(); ++i) checkView(views[i], buffers);
  for (size_t i = 0; i < accessors.size(); ++i) checkAccessor(accessors[i], views, document.limits);
}

}  // namespace limn::gltf
