#pragma once

#include "tiles/bytes.hpp"
#include "tiles/json.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace draco {
class PointCloud;
} // namespace draco

namespace firetwin::tiles {

/// Decoded Draco data: a mesh or a point cloud.
class DracoData {
public:
  /// Decodes a mesh. @throws InputError if the numbers of points and triangles differ from these
  static DracoData mesh(Bytes compressed, std::size_t points, std::size_t triangles,
                        const Node& place);
  /// Decodes a point cloud. @throws InputError if the number of points differs from this
  static DracoData cloud(Bytes compressed, std::size_t points, const Node& place);

  std::size_t points() const;
  std::vector<std::uint32_t> triangles() const; ///< m x 3
  /// Attribute with a unique id: points x components. Normalized integers are scaled to 0..1 or
  /// -1..1.
  std::vector<float> floats(const Node& id, std::size_t components, bool normalized) const;

private:
  explicit DracoData(std::shared_ptr<const draco::PointCloud> data) : data_(std::move(data)) {}

  std::shared_ptr<const draco::PointCloud> data_;
};

} // namespace firetwin::tiles
