#pragma once

#include "tiles/bytes.hpp"
#include "tiles/container.hpp"
#include "tiles/json.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace firetwin::tiles {

/// Resolves `uri` against a folder such as "models/".
std::string resolve_uri(const std::string& folder, const std::string& uri);
/// The folder of a uri with a trailing slash; empty if it has none.
std::string folder_of(const std::string& uri);
bool is_data_uri(const std::string& uri);
/// Decodes a data: uri. @throws InputError if it is not base64
std::vector<std::uint8_t> decode_data_uri(const Node& uri);

/// Callback with the number of bytes about to be allocated; throws beyond the memory limit.
using ReserveBytes = std::function<void(std::size_t)>;

/// Buffers and buffer views of a document. Each is decoded once, on first use. The content and the
/// resources must outlive it.
class Buffers {
public:
  Buffers(const Container& container, const Resources& resources, std::string folder,
          ReserveBytes reserve_bytes);

  struct View {
    Bytes bytes;
    std::size_t stride = 0; ///< 0 if elements are tightly packed
  };

  /// Returns the buffer view with this index. @throws InputError
  View view(const Node& index);

  /// Uris of buffers that are neither embedded in the document nor among the resources.
  std::vector<std::string> missing_uris() const;

private:
  Bytes buffer(const Node& index);
  Bytes slice(const Node& described);
  Bytes decompressed(std::size_t index, const Node& view, const Node& extension);

  std::vector<Node> buffers_;
  std::vector<Node> views_;
  std::optional<Bytes> binary_;
  const Resources* resources_;
  std::string folder_;
  ReserveBytes reserve_bytes_;
  std::map<std::size_t, std::vector<std::uint8_t>> decoded_buffers_;
  std::map<std::size_t, std::vector<std::uint8_t>> decoded_views_;
};

} // namespace firetwin::tiles
