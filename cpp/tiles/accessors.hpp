#pragma once

#include "tiles/buffers.hpp"
#include "tiles/json.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace firetwin::tiles {

/// What a document says of an accessor, checked.
struct AccessorType {
  std::size_t count = 0;
  std::size_t components = 1;
  unsigned component = 0; ///< 5120 to 5126, as glTF numbers them
  bool normalized = false;

  std::size_t component_bytes() const;
  std::size_t bytes() const { return components * component_bytes(); }
};

/// Reads accessors of any component type, stride and sparseness.
class Accessors {
public:
  Accessors(const Node& root, Buffers& buffers, ReserveBytes reserve_bytes)
      : nodes_(root.elements("accessors")), buffers_(&buffers),
        reserve_bytes_(std::move(reserve_bytes)) {}

  /// @throws InputError
  AccessorType type(const Node& index) const;
  /// count x components; normalized integers become -1 to 1.
  std::vector<float> floats(const Node& index);
  /// Whole numbers. @throws InputError where the accessor is not one of unsigned scalars
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
