#include "tiles/meshopt.hpp"

#include "tiles/limits.hpp"

#include <meshoptimizer.h>

namespace firetwin::tiles {
namespace {

/// True if the extension's specification allows this stride for the mode and the filter.
bool stride_fits(const MeshoptView& view) {
  const std::size_t stride = view.stride;
  if (view.mode == "TRIANGLES" || view.mode == "INDICES") {
    return stride == 2 || stride == 4;
  }
  if (view.filter == "OCTAHEDRAL") {
    return stride == 4 || stride == 8;
  }
  if (view.filter == "QUATERNION") {
    return stride == 8;
  }
  return stride > 0 && stride <= 256 && stride % 4 == 0;
}

void check_names(const MeshoptView& view, const Node& extension) {
  if (view.mode != "ATTRIBUTES" && view.mode != "TRIANGLES" && view.mode != "INDICES") {
    extension.refuse("has an unknown mode: " + view.mode);
  }
  if (view.filter != "NONE" && view.filter != "OCTAHEDRAL" && view.filter != "QUATERNION" &&
      view.filter != "EXPONENTIAL") {
    extension.refuse("has an unknown filter: " + view.filter);
  }
  if (view.mode != "ATTRIBUTES" && view.filter != "NONE") {
    extension.refuse("has a filter for indices; only attributes can be filtered");
  }
}

/// False if the data is damaged.
bool decode(const MeshoptView& view, Bytes from, std::uint8_t* to) {
  if (view.mode == "ATTRIBUTES") {
    return meshopt_decodeVertexBuffer(to, view.count, view.stride, from.data(), from.size()) == 0;
  }
  if (view.mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(to, view.count, view.stride, from.data(), from.size()) == 0;
  }
  return meshopt_decodeIndexSequence(to, view.count, view.stride, from.data(), from.size()) == 0;
}

} // namespace

MeshoptView read_meshopt(const Node& extension) {
  MeshoptView view{extension.at("count").integer(), extension.at("byteStride").integer(),
                   extension.at("mode").text(), extension.text("filter", "NONE")};
  check_names(view, extension);
  if (!stride_fits(view)) {
    extension.at("byteStride")
        .refuse("must not be " + std::to_string(view.stride) + " for this mode and filter");
  }
  if (view.count > max_indices || (view.mode == "TRIANGLES" && view.count % 3 != 0)) {
    extension.at("count").refuse("must not be " + std::to_string(view.count) + " for this mode");
  }
  return view;
}

std::vector<std::uint8_t> decompress_meshopt(const MeshoptView& view, Bytes compressed,
                                             const Node& extension) {
  std::vector<std::uint8_t> bytes(view.count * view.stride);
  if (view.count > 0 && !decode(view, compressed, bytes.data())) {
    extension.refuse("its compressed data is damaged");
  }
  if (view.filter == "OCTAHEDRAL") {
    meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
  } else if (view.filter == "QUATERNION") {
    meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
  } else if (view.filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
  }
  return bytes;
}

} // namespace firetwin::tiles
