#include "tiles/triangles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace firetwin::tiles {
namespace {

using Place = std::array<std::uint32_t, 3>;

struct HashPlace {
  std::size_t operator()(const Place& place) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t bits : place) {
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15U; // Knuth's multiplicative hashing
      hash ^= hash >> 29U;
    }
    return static_cast<std::size_t>(hash);
  }
};

Vector vertex(const std::vector<float>& position, std::size_t i) {
  return {static_cast<double>(position[3 * i]), static_cast<double>(position[3 * i + 1]),
          static_cast<double>(position[3 * i + 2])};
}

/// Numbers the distinct positions. Returns the number of each vertex's position, and their count.
std::pair<std::vector<std::uint32_t>, std::size_t>
weld_positions(const std::vector<float>& position) {
  const std::size_t n = position.size() / 3;
  std::unordered_map<Place, std::uint32_t, HashPlace> places;
  places.reserve(n);
  std::vector<std::uint32_t> number(n);
  for (std::size_t i = 0; i < n; ++i) {
    Place place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = std::bit_cast<std::uint32_t>(position[3 * i + axis] + 0.0F); // -0 becomes 0
    }
    number[i] = places.try_emplace(place, static_cast<std::uint32_t>(places.size())).first->second;
  }
  return {std::move(number), places.size()};
}

} // namespace

std::vector<std::uint32_t> list_triangles(std::vector<std::uint32_t> corners, std::size_t mode) {
  if (mode == 4) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<std::uint32_t> list;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    if (mode == 5) {
      const bool odd = i % 2 == 1;
      list.insert(list.end(), {corners[i - 2], corners[odd ? i : i - 1], corners[odd ? i - 1 : i]});
    } else {
      list.insert(list.end(), {corners[0], corners[i - 1], corners[i]});
    }
  }
  return list;
}

void drop_invalid_triangles(const std::vector<float>& position,
                            std::vector<std::uint32_t>& triangles) {
  const auto finite = [&](std::uint32_t i) {
    return std::isfinite(position[3 * std::size_t{i}]) &&
           std::isfinite(position[3 * std::size_t{i} + 1]) &&
           std::isfinite(position[3 * std::size_t{i} + 2]);
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    if (a != b && b != c && c != a && finite(a) && finite(b) && finite(c)) {
      triangles[kept++] = a;
      triangles[kept++] = b;
      triangles[kept++] = c;
    }
  }
  triangles.resize(kept);
}

std::vector<std::uint32_t> compact_vertices(std::size_t vertices,
                                            std::vector<std::uint32_t>& triangles) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(vertices, unused);
  for (const std::uint32_t i : triangles) {
    number[i] = 0;
  }
  std::vector<std::uint32_t> used;
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (number[i] != unused) {
      number[i] = static_cast<std::uint32_t>(used.size());
      used.push_back(i);
    }
  }
  for (std::uint32_t& i : triangles) {
    i = number[i];
  }
  return used;
}

std::vector<float> smooth_normals(const std::vector<float>& position,
                                  const std::vector<std::uint32_t>& triangles) {
  const auto [place, places] = weld_positions(position);
  std::vector<Vector> sums(places);
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const Vector a = vertex(position, triangles[i]);
    const Vector twice = cross(minus(vertex(position, triangles[i + 1]), a),
                               minus(vertex(position, triangles[i + 2]), a));
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Vector& sum = sums[place[triangles[i + corner]]];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sum[axis] += twice[axis];
      }
    }
  }
  std::vector<float> normals(position.size());
  for (std::size_t i = 0; i < place.size(); ++i) {
    const Vector& sum = sums[place[i]];
    const double length = std::sqrt(dot(sum, sum));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      normals[3 * i + axis] = length > 0.0 ? static_cast<float>(sum[axis] / length) : 0.0F;
    }
  }
  return normals;
}

} // namespace firetwin::tiles
