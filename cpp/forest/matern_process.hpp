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

/// A rectangle of the plane, m; includes its left and lower edges.
struct Area {
  double left, right, low, high;
};

/// Matérn type II hard-core point process (B. Matern 1960, "Spatial variation", Meddelanden fran
/// Statens Skogsforskningsinstitut 49:5): positions of trees with a minimum distance.
///
/// The parent process is Poisson. Each point has a mark, its birth order. A point is retained if no
/// point with a smaller mark lies within its exclusion disc. The marks are densities: m points per
/// m2 have a mark below m. Points with an exclusion disc of area a (m2) and marks up to `max_mark`
/// are retained with the density (1 - exp(-max_mark a)) / a. No two retained points are closer than
/// the disc's radius. Beyond twice the radius the pair correlation is 1, exactly. A point that a
/// larger disc retains is retained by a smaller one too, so thinning a stand is a larger disc. The
/// area may vary in space.
///
/// Points are hashes of a seed and their square of the plane; squares are larger for smaller marks.
/// So points do not depend on the order of calls, and sparse stands are cheap. Use one object per
/// thread: it caches the points of the last gathered area.
class MaternProcess {
public:
  static constexpr double max_mark = 3.0 * max_stem_density; ///< 1/m2
  /// Largest mark considered, relative to the density of retained points. Only 2 % of points with
  /// larger marks would be retained.
  static constexpr double max_mark_ratio = 4.0;

  struct MarkedPoint {
    double x, y; ///< m
    double mark; ///< birth order: density of the points before it, 1/m2
    std::uint64_t bits;
  };

  explicit MaternProcess(std::uint64_t seed);

  /// Area of the exclusion disc (m2) that retains `density` (1/m2, at most `max_stem_density`) of
  /// the points with marks below `max_mark_ratio` x density; within 0.1 %.
  static double exclusion_area(double density);

  /// Fraction of the retained points at this density (1/m2) that have a smaller mark.
  static double older_fraction(double mark, double density);

  /// Generates the points with marks below `before` (1/m2) in an area and its surroundings.
  void gather(const Area& area, double before);

  /// Points as a structure of arrays; `size` entries are valid.
  struct PointArrays {
    std::size_t size = 0;
    std::vector<double> x, y, mark;
    std::vector<std::uint64_t> bits;
    void resize(std::size_t points);
  };

  /// Points with marks below `before` in a part of the gathered area, in a fixed order.
  void find(const Area& area, double before, PointArrays& out) const;

  /// Returns true if a point is retained: no point with a smaller mark is in its exclusion disc of
  /// `area` (m2). The test is fast in the gathered area.
  bool is_retained(const MarkedPoint& point, double area) const;

private:
  static constexpr std::size_t octaves = 7, most = 7;

  /// Points between two marks, one per square on average.
  struct Octave {
    std::uint64_t seed;
    double begin, end;      ///< range of marks
    double side, per_metre; ///< side of the squares, m, and its inverse

    /// Index of the square of a point along an axis.
    std::int64_t number(double place) const {
      const double squares = place * per_metre;
      const auto whole = static_cast<std::int64_t>(squares);
      return whole - (squares < static_cast<double>(whole));
    }

    std::uint64_t line(std::int64_t row) const {
      return mix(seed, static_cast<std::uint64_t>(row));
    }
    /// Writes the keys of the points in a square. Returns the number of valid ones.
    std::size_t keys(std::uint64_t line, std::int64_t column,
                     std::span<std::uint64_t, most> out) const;
    MarkedPoint point(double column, double row, std::uint64_t key) const;
    /// Computes the points of n keys in a row of squares; branch-free, so that it vectorizes.
    void points(double row, std::size_t n, const double* column, const std::uint64_t* key,
                double* x, double* y, double* mark, std::uint64_t* bits) const;
  };

  /// Work space for a row of squares.
  struct Row {
    std::vector<std::uint64_t> key;
    std::vector<double> column;
    std::vector<std::uint32_t> place; ///< index of each point among the valid ones
    std::vector<std::size_t> begin;   ///< first point of each square
    void resize(std::size_t points);
  };

  /// The points of an octave in a rectangle of squares, row by row.
  struct Squares : PointArrays {
    std::int64_t column = 0, row = 0; ///< indices of the first square
    std::int64_t columns = 0, rows = 0;
    std::vector<std::uint32_t> first; ///< first point of each square, and the end

    std::size_t begin(std::int64_t at_row, std::int64_t at_column) const {
      return first[static_cast<std::size_t>((at_row - row) * columns + at_column - column)];
    }
    std::size_t end(std::int64_t at_row, std::int64_t at_column) const {
      return begin(at_row, at_column + 1);
    }
    /// Adds points of a row of squares with marks below `before`.
    void add(const Octave& octave, std::int64_t at_row, double before, Row& work);
  };

  /// All gathered points in buckets about as large as an exclusion disc, row by row.
  struct PointBuckets {
    Area area{};
    double per_metre = 0.0; ///< buckets per metre
    std::size_t columns = 0;
    std::vector<std::uint32_t> first; ///< first point of each bucket, and the end
    std::vector<double> x, y, mark;

    /// Index of the bucket of a point in the area.
    std::size_t number(double at_x, double at_y) const {
      const auto column = static_cast<std::int32_t>((at_x - area.left) * per_metre);
      const auto row = static_cast<std::int32_t>((at_y - area.low) * per_metre);
      return static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
    }
    void sort(const Area& gathered, double bucket, const std::array<Squares, octaves>& known);
  };

  bool is_retained_anywhere(const MarkedPoint& point, const Area& round, double square) const;

  std::array<Octave, octaves> octaves_; ///< from the largest marks down
  std::array<Squares, octaves> known_;
  Row row_;
  PointBuckets buckets_;
};

} // namespace firetwin::forest
