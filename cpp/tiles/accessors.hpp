#pragma once

#include "tiles/buffers.hpp"
#include "tiles/json.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace firetwin::tiles {

/// Validated properties of an accessor.
struct AccessorType {
  std::size_t count = 0;
  std::size_t components = 1;
  unsigned component = 0; ///< glTF component type, 5120 to 5126
  bool normalized = false;

  std::size_t component_bytes() const;
  std::size_t bytes() const { return components * component_bytes(); }
};

/// Reads accessors of any component type and stride, dense or sparse.
class Accessors {
public:
  Accessors(const Node& root, Buffers& buffers, ReserveBytes reserve_bytes)
      : nodes_(root.elements("accessors")), buffers_(&buffers),
        reserve_bytes_(std::move(reserve_bytes)) {}

  /// @throws InputError
  AccessorType type(const Node& index) const;
  /// count x components; normalized integers are scaled to -1..1.
  std::vector<float> floats(const Node& index);
  /// Indices. @throws InputError if the accessor does not hold unsigned scalars
  std::vector<std::uint32_t> indices(const Node& index);

private:
  template <class T> void read(const Node& node, const AccessorType& type, std::vector<T>& out);
  template <class T>
  void read_sparse(const Node& sparse, const AccessorType& type, std::vector<T>& out);
  Bytes elements(const Node& place, Buffers::View view, std::size_t count, std::size_t bytes,
                 std::size_t& stride);

  std::vector<Node> nodes_;
  Buffers* buffers_;
  ReserveBytes reserve_bytes_;
};

} // namespace firetwin::tiles
