#pragma once

#include "tiles/assembler.hpp"
#include "tiles/buffers.hpp"
#include "tiles/json.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace firetwin::tiles {

/// Material of a primitive: its index, texture coordinate set and texture transform.
struct MaterialUse {
  int material = -1;           ///< index in the tile
  std::size_t coordinates = 0; ///< n of TEXCOORD_n
  bool textured = false;
  /// KHR_texture_transform: u' = t[0] u + t[1] v + t[2], v' = t[3] u + t[4] v + t[5].
  std::array<double, 6> transform = {1, 0, 0, 0, 1, 0};
};

/// Materials and images of one document; each one that is used is added to the tile once.
class Materials {
public:
  Materials(const Node& root, Buffers& buffers, const Resources& resources, std::string folder,
            Assembler& assembler);

  /// Adds the material with this index to the tile on first use. @throws InputError
  MaterialUse use(const Node& index);

private:
  MaterialUse read(const Node& node);
  void read_texture(const Node& reference, Material& material, MaterialUse& use);
  int image(const Node& index);
  Image read_image(const Node& node);

  std::vector<Node> materials_, textures_, samplers_, images_;
  Buffers* buffers_;
  const Resources* resources_;
  std::string folder_;
  Assembler* assembler_;
  std::map<std::size_t, MaterialUse> used_;
  std::map<std::size_t, int> used_images_;
};

} // namespace firetwin::tiles
