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

/// Decoded Draco data: a mesh, or points.
class DracoData {
public:
  /// Decodes a mesh that must have so many points and triangles. @throws InputError
  static DracoData mesh(Bytes compressed, std::size_t points, std::size_t triangles,
                        const Node& place);
  /// Decodes a cloud of so many points. @throws InputError
  static DracoData cloud(Bytes compressed, std::size_t points, const Node& place);

  std::size_t points() const;
  std::vector<std::uint32_t> triangles() const; ///< m x 3
  /// An attribute by its unique id: points x components, integers over their largest if normalized.
  std::vector<float> floats(const Node& id, std::size_t components, bool normalized) const;

private:
  explicit DracoData(std::shared_ptr<const draco::PointCloud> data) : data_(std::move(data)) {}

  std::shared_ptr<const draco::PointCloud> data_;
};

} // namespace firetwin::tiles
