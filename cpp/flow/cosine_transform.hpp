#pragma once

#include "flow/lattice.hpp"

#include <oneapi/tbb/cache_aligned_allocator.h>

#include <memory>
#include <vector>

namespace firetwin::flow {

/// Discrete cosine transform along the columns of a matrix: DCT-II forward, DCT-III backward. Two
/// columns are combined into one complex Fourier transform of the same length (Makhoul 1980, "A
/// fast cosine transform in one and two dimensions", IEEE Trans. Acoust. Speech Signal Process.
/// 28), because FFTW vectorises complex transforms but not cosine transforms.
class CosineTransform {
public:
  using Rows = std::vector<float, tbb::cache_aligned_allocator<float>>;

  /// Transforms `count` columns of `length` numbers.
  CosineTransform(Index length, Index count);
  ~CosineTransform();
  CosineTransform(const CosineTransform&) = delete;
  CosineTransform& operator=(const CosineTransform&) = delete;

  /// Allocates a matrix of `length` rows, `stride()` floats apart.
  Rows make_matrix() const { return Rows(static_cast<std::size_t>(length_ * stride())); }
  Index stride() const { return 2 * half_; }

  /// Offset of row j in the matrix, before `forward` and after `backward`.
  Index row_offset(Index j) const { return (j % 2 == 0 ? j / 2 : length_ - 1 - j / 2) * stride(); }

  /// Copies numbers into a row and fills its padding with zeros.
  void copy_row(const float* from, float* row) const;
  void clear_rest(float* row) const;

  /// Forward transform (DCT-II) to modes in order: mode k is 2 sum(x_j cos(pi k (j + 1/2) /
  /// length)).
  void forward(Rows& rows) const;

  /// Backward transform (DCT-III) of modes in order, scaled by 2 x `length`.
  void backward(Rows& rows) const;

private:
  struct Plans;

  template <class Function> void pairs(const Function& f) const;
  void middle(float* data) const;

  Index length_;
  Index count_;
  Index half_;                   ///< columns, padded to full lanes; each is paired with another one
  std::vector<float> cos_, sin_; ///< of pi k / (2 length), up to the middle
  std::unique_ptr<Plans> plans_;
};

} // namespace firetwin::flow
