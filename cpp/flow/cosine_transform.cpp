#include "flow/cosine_transform.hpp"

#include "base/clones.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

namespace firetwin::flow {
namespace {

/// FFTW's planner is not thread-safe.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

struct Destroy {
  void operator()(fftwf_plan_s* plan) const {
    const std::lock_guard lock(planner());
    fftwf_destroy_plan(plan);
  }
};
using Plan = std::unique_ptr<fftwf_plan_s, Destroy>;

/// Plans an in-place transform of `half` columns whose real and imaginary parts are `half` apart.
/// The plan is estimated, not measured, so that it, and every digit of the result, is reproducible.
Plan plan(Index length, Index half, float* real, float* imaginary) {
  const int n = static_cast<int>(length), count = static_cast<int>(half), row = 2 * count;
  const fftwf_iodim along{n, row, row}, across{count, 1, 1};
  const std::lock_guard lock(planner());
  return Plan(fftwf_plan_guru_split_dft(1, &along, 1, &across, real, imaginary, real, imaginary,
                                        FFTW_ESTIMATE));
}

/// Splits a row of modes k and of modes length - k of one complex transform into its two real
/// transforms.
FIRETWIN_CLONES("avx512f", "avx2")
void part_rows(Index half, float cosine, float sine, float* __restrict k, float* __restrict m) {
  for (Index i = 0; i < half; ++i) {
    const float real = k[i] + m[i], real_less = k[i] - m[i];
    const float imaginary = k[half + i] + m[half + i], less = k[half + i] - m[half + i];
    k[i] = cosine * real + sine * less;
    m[i] = sine * real - cosine * less;
    k[half + i] = cosine * imaginary - sine * real_less;
    m[half + i] = sine * imaginary + cosine * real_less;
  }
}

/// Inverse of the split above, for a backward transform.
FIRETWIN_CLONES("avx512f", "avx2")
void join_rows(Index half, float cosine, float sine, float* __restrict k, float* __restrict m) {
  for (Index i = 0; i < half; ++i) {
    const float a = cosine * k[i] + sine * m[i], b = sine * k[i] - cosine * m[i];
    const float c = cosine * k[half + i] + sine * m[half + i];
    const float d = sine * k[half + i] - cosine * m[half + i];
    k[i] = a - d;
    m[i] = a + d;
    k[half + i] = c + b;
    m[half + i] = c - b;
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void times_row(Index n, float factor, float* __restrict row) {
  for (Index i = 0; i < n; ++i) {
    row[i] *= factor;
  }
}

} // namespace

struct CosineTransform::Plans {
  Plan forward, backward;
};

CosineTransform::CosineTransform(Index length, Index count)
    : length_(length), count_(count), half_(whole_lanes((count + 1) / 2)) {
  for (Index k = 0; 2 * k <= length; ++k) {
    const double angle =
        0.5 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length);
    cos_.push_back(static_cast<float>(std::cos(angle)));
    sin_.push_back(static_cast<float>(std::sin(angle)));
  }
  Rows rows = make_matrix();
  float* data = rows.data();
  plans_ = std::make_unique<Plans>(
      Plans{plan(length, half_, data, data + half_), plan(length, half_, data + half_, data)});
}

CosineTransform::~CosineTransform() = default;

/// Calls f(k, length - k) for paired modes: all except the first and the middle one.
template <class Function> void CosineTransform::pairs(const Function& f) const {
  for (Index k = 1; 2 * k < length_; ++k) {
    f(cos_[static_cast<std::size_t>(k)], sin_[static_cast<std::size_t>(k)], k * stride(),
      (length_ - k) * stride());
  }
}

void CosineTransform::copy_row(const float* from, float* row) const {
  std::copy_n(from, count_, row);
  clear_rest(row);
}

void CosineTransform::clear_rest(float* row) const {
  std::fill_n(row + count_, stride() - count_, 0.0F);
}

void CosineTransform::forward(Rows& rows) const {
  float* data = rows.data();
  fftwf_execute_split_dft(plans_->forward.get(), data, data + half_, data, data + half_);
  pairs([&](float c, float s, Index k, Index m) { part_rows(half_, c, s, data + k, data + m); });
  times_row(stride(), 2.0F, data);
  middle(data);
}

void CosineTransform::backward(Rows& rows) const {
  float* data = rows.data();
  pairs([&](float c, float s, Index k, Index m) { join_rows(half_, c, s, data + k, data + m); });
  middle(data);
  fftwf_execute_split_dft(plans_->backward.get(), data + half_, data, data + half_, data);
}

void CosineTransform::middle(float* data) const {
  if (length_ % 2 == 0) {
    times_row(stride(), std::numbers::sqrt2_v<float>, data + length_ / 2 * stride());
  }
}

} // namespace firetwin::flow
