#pragma once

#include "base/random.hpp"
#include "forest/allometry.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace firetwin::forest {

/// Where trees stand that keep their distance: Matern's second hard-core process (B. Matern 1960,
/// "Spatial variation", Meddelanden fran Statens Skogsforskningsinstitut 49:5).
///
/// Trees are born at random places of the plane, one by one, and each keeps its place unless an
/// older one is nearer than its reach. Of births at all times up to `latest`, per m2, those with a
/// reach of a round area a (m2) that are left have the density (1 - exp(-latest a)) / a; no two of
/// them are closer, and beyond twice the reach they know nothing of each other (pair correlation 1,
/// exactly). What is left with a larger reach was left with a smaller one too, so thinning a stand
/// is nothing but a larger reach, and it may differ from place to place.
///
/// Births are hashes: of a seed, and of the square of the plane that they are in,
/// with larger squares for earlier times. Whoever asks for a place gets the same births, whatever
/// was asked before, and sparse stands cost as little as they hold. One object per thread: it
/// remembers squares.
class Births {
public:
  static constexpr double latest = 3.0 * most_stems; ///< 1/m2
  /// So many times their density trees can be born at the latest: of others 2 % would be left.
  static constexpr double last_chance = 4.0;

  struct Birth {
    double x, y; ///< m
    double time; ///< how many were born before it, 1/m2
    std::uint64_t bits;
  };

  explicit Births(std::uint64_t seed);

  /// The area of the reach (m2) that leaves `density` (1/m2, at most `most_stems`) of all births
  /// before `last_chance` times the density; within 0.1 %.
  static double reach(double density);

  /// Which part of all that are left at this density (1/m2) are older than a birth.
  static double older(double time, double density);

  /// Calls visit(birth) for each before `time` in a rectangle (its lower and left edges included),
  /// always in the same order.
  template <class Visit>
  void visit(double left, double right, double low, double high, double time, const Visit& visit) {
    for (int octave = octaves - 1; octave >= 0; --octave) {
      const auto k = static_cast<std::size_t>(octave);
      if (begin_[k] >= time) {
        break;
      }
      for (auto row = number(low, k); row <= number(high, k); ++row) {
        for (auto column = number(left, k); column <= number(right, k); ++column) {
          const Square square = at(octave, column, row); // a copy: visits remember others
          for (int i = 0; i < square.count; ++i) {
            const Birth b = birth(octave, square, i);
            if (b.time < time && b.x >= left && b.x < right && b.y >= low && b.y < high) {
              visit(b);
            }
          }
        }
      }
    }
  }

  /// Whether nothing older is within this round area (m2) of a birth.
  bool stands(const Birth& birth, double reach);

private:
  static constexpr int octaves = 7, most = 7, remembered = 64;

  struct Square {
    std::int64_t column = 0, row = 0;
    int count = -1;
    std::array<std::uint64_t, most> bits{}; ///< place and time of each birth
  };

  /// Of the square that a place is in along an axis.
  std::int64_t number(double place, std::size_t octave) const {
    const double squares = place * per_metre_[octave];
    const auto whole = static_cast<std::int64_t>(squares);
    return whole - (squares < static_cast<double>(whole));
  }

  const Square& at(int octave, std::int64_t column, std::int64_t row) {
    constexpr std::int64_t last = remembered - 1;
    const auto line = static_cast<std::size_t>(octave * remembered + (row & last));
    Square& square = known_[line * remembered + static_cast<std::size_t>(column & last)];
    if (square.count < 0 || square.column != column || square.row != row) {
      square.column = column;
      square.row = row;
      fill(square, octave);
    }
    return square;
  }
  void fill(Square& square, int octave) const;
  Birth birth(int octave, const Square& square, int i) const {
    const std::uint64_t bits = square.bits[static_cast<std::size_t>(i)];
    const auto k = static_cast<std::size_t>(octave);
    const auto part =
        [](std::uint64_t number) { // 21 bits, by way of what processors convert at once
          return static_cast<double>(static_cast<std::int32_t>(number & 0x1FFFFF)) * 0x1p-21;
        };
    return {(static_cast<double>(square.column) + part(bits >> 43)) * side_[k],
            (static_cast<double>(square.row) + part(bits >> 22)) * side_[k],
            begin_[k] + (end_[k] - begin_[k]) * part(bits >> 1), bits};
  }

  std::array<std::uint64_t, octaves> seed_;
  std::array<double, octaves> begin_, end_; ///< of the times of an octave's births
  std::array<double, octaves> side_;        ///< of its squares, m: a birth in each on average
  std::array<double, octaves> per_metre_;   ///< squares
  std::vector<Square> known_;
};

} // namespace firetwin::forest
