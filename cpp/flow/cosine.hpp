#pragma once

#include "flow/lattice.hpp"

#include <oneapi/tbb/cache_aligned_allocator.h>

#include <memory>
#include <vector>

namespace firetwin::flow {

/// Cosine transforms (DCT-II, and DCT-III back) of columns of a matrix, two columns as one complex
/// Fourier transform of their length (Makhoul 1980, "A fast cosine transform in one and two
/// dimensions", IEEE Trans. Acoust. Speech Signal Process. 28): what FFTW does in lanes, and its
/// own cosine transforms number by number.
class Cosines {
public:
  using Rows = std::vector<float, tbb::cache_aligned_allocator<float>>;

  /// Of `count` columns of `length` numbers.
  Cosines(Index length, Index count);
  ~Cosines();
  Cosines(const Cosines&) = delete;
  Cosines& operator=(const Cosines&) = delete;

  /// Room for a matrix of `length` rows, `stride()` floats apart.
  Rows room() const { return Rows(static_cast<std::size_t>(length_ * stride())); }
  Index stride() const { return 2 * half_; }

  /// Where row j is expected before a transform, and left after one back.
  Index place(Index j) const { return (j % 2 == 0 ? j / 2 : length_ - 1 - j / 2) * stride(); }

  /// Puts numbers into a row, and nothing into what is left of it, which is transformed too.
  void put(const float* from, float* row) const;
  void clear_rest(float* row) const;

  /// To modes in order: mode k is 2 sum(x_j cos(pi k (j + 1/2) / length)).
  void forward(Rows& rows) const;

  /// From modes in order to 2 x `length` times what they were made from.
  void backward(Rows& rows) const;

private:
  struct Plans;

  template <class Function> void pairs(const Function& f) const;
  void middle(float* data) const;

  Index length_;
  Index count_;
  Index half_;                   ///< columns, whole lanes of them, each joined to one of the others
  std::vector<float> cos_, sin_; ///< of pi k / (2 length), to the middle
  std::unique_ptr<Plans> plans_;
};

} // namespace firetwin::flow
