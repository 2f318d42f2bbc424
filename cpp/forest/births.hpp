#pragma once

#include "base/random.hpp"
#include "forest/allometry.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::forest {

/// A rectangle of the plane, m; its left and low edges are in it.
struct Area {
  double left, right, low, high;
};

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
/// was asked before, and sparse stands cost as little as they hold. One object per thread: it holds
/// the births of the area that was gathered last.
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

  /// Works out the births before a time (1/m2) in an area and round it.
  void gather(const Area& area, double before);

  /// Births side by side, the first `size` of what the arrays hold.
  struct Many {
    std::size_t size = 0;
    std::vector<double> x, y, time;
    std::vector<std::uint64_t> bits;
    void resize(std::size_t births);
  };

  /// Those before a time in a part of what was gathered, always in the same order.
  void find(const Area& area, double before, Many& out) const;

  /// Whether nothing older is within this round area (m2) of a birth; quick for those gathered.
  bool stands(const Birth& birth, double reach) const;

private:
  static constexpr std::size_t octaves = 7, most = 7;

  /// Births between two times, one on average in each square.
  struct Octave {
    std::uint64_t seed;
    double begin, end;      ///< of the times
    double side, per_metre; ///< of the squares, m, 1/m

    /// Of the square that a place is in along an axis.
    std::int64_t number(double place) const {
      const double squares = place * per_metre;
      const auto whole = static_cast<std::int64_t>(squares);
      return whole - (squares < static_cast<double>(whole));
    }

    std::uint64_t line(std::int64_t row) const {
      return mix(seed, static_cast<std::uint64_t>(row));
    }
    /// The keys of the births in a square; how many of those written count.
    std::size_t keys(std::uint64_t line, std::int64_t column,
                     std::span<std::uint64_t, most> out) const;
    Birth birth(double column, double row, std::uint64_t key) const;
    /// Those of n keys in the squares of a row; without branches, for many at once.
    void births(double row, std::size_t n, const double* column, const std::uint64_t* key,
                double* x, double* y, double* time, std::uint64_t* bits) const;
  };

  /// What is needed while a row of squares is worked out; kept for its memory alone.
  struct Row {
    std::vector<std::uint64_t> key;
    std::vector<double> column;
    std::vector<std::uint32_t> place; ///< of each birth among those kept
    std::vector<std::size_t> begin;   ///< of each square's births
    void resize(std::size_t births);
  };

  /// The births of an octave in a rectangle of squares, row by row.
  struct Squares : Many {
    std::int64_t column = 0, row = 0; ///< of the first
    std::int64_t columns = 0, rows = 0;
    std::vector<std::uint32_t> first; ///< of each square's births, and the end

    std::size_t begin(std::int64_t at_row, std::int64_t at_column) const {
      return first[static_cast<std::size_t>((at_row - row) * columns + at_column - column)];
    }
    std::size_t end(std::int64_t at_row, std::int64_t at_column) const {
      return begin(at_row, at_column + 1);
    }
    /// Those of a row of squares that are born before a time.
    void add(const Octave& octave, std::int64_t at_row, double before, Row& work);
  };

  /// All births gathered by buckets about as large as their reach, row by row.
  struct Crowd {
    Area area{};
    double per_metre = 0.0; ///< buckets
    std::size_t columns = 0;
    std::vector<std::uint32_t> first; ///< of each bucket's births, and the end
    std::vector<double> x, y, time;

    /// Of the bucket that a place in the area is in.
    std::size_t number(double at_x, double at_y) const {
      const auto column = static_cast<std::int32_t>((at_x - area.left) * per_metre);
      const auto row = static_cast<std::int32_t>((at_y - area.low) * per_metre);
      return static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
    }
    void sort(const Area& gathered, double bucket, const std::array<Squares, octaves>& known);
  };

  bool stands_anywhere(const Birth& birth, const Area& round, double square) const;

  std::array<Octave, octaves> octaves_; ///< the latest first
  std::array<Squares, octaves> known_;
  Row row_;
  Crowd crowd_;
};

} // namespace firetwin::forest
