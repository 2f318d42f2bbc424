#include "flow/drift.hpp"

#include "base/check.hpp"
#include "flow/linear_interpolator.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flow {
namespace {

constexpr Index coarsening = 2; // cells

Index points(Index cells) {
  return (cells + coarsening - 1) / coarsening;
}

} // namespace

Drift::Drift(std::shared_ptr<const Solver> solver, double period)
    : solver_(std::move(solver)), shape_{}, period_(period), time_(solver_->time()) {
  check_above_zero(period, "period");
  turns_ = turns_at(time_);
  const Lattice& l = solver_->lattice();
  shape_ = {points(l.nz), points(l.ny), points(l.nx)};
  for (Index k = 0; k < l.nz; k += coarsening) {
    middle_.push_back(l.middle[static_cast<std::size_t>(k)]);
  }
  speed_.resize(3 * shape_.size());
  values_.resize(parts * shape_.size());
  next_.resize(parts * shape_.size());
}

std::array<std::int64_t, Drift::phases> Drift::turns_at(double time) const {
  std::array<std::int64_t, phases> result{};
  for (std::size_t p = 0; p < phases; ++p) {
    result[p] = static_cast<std::int64_t>(
        std::floor(time / period_ + static_cast<double>(p) / static_cast<double>(phases)));
  }
  return result;
}

std::array<float, Drift::phases> Drift::weights() const {
  std::array<double, phases> result{};
  double squares = 0.0;
  for (std::size_t p = 0; p < phases; ++p) {
    const double turn = time_ / period_ + static_cast<double>(p) / static_cast<double>(phases);
    result[p] = 1.0 - std::abs(2.0 * (turn - std::floor(turn)) - 1.0);
    squares += result[p] * result[p];
  }
  std::array<float, phases> scaled{};
  std::transform(result.begin(), result.end(), scaled.begin(),
                 [&](double w) { return static_cast<float>(w / std::sqrt(squares)); });
  return scaled;
}

void Drift::find_speed() {
  const Lattice& l = solver_->lattice();
  const Wind& wind = solver_->state().wind;
  const auto across = static_cast<float>(0.5 / (l.spacing * static_cast<double>(coarsening)));
  each(shape_.nz, [&](Index level) {
    const Index k = level * coarsening, above = std::min(level + 1, shape_.nz - 1),
                below = std::max(level - 1, Index{0});
    const double gap = shape_.nz > 1 ? (middle_[static_cast<std::size_t>(above)] -
                                        middle_[static_cast<std::size_t>(below)]) /
                                           static_cast<double>(above - below)
                                     : l.depth[0];
    const auto upward = static_cast<float>(0.5 / gap);
    float* to = speed_.data() + 3 * level * shape_.ny * shape_.nx;
    for (Index j = 0; j < l.ny; j += coarsening) {
      const float *u = wind.u.row(k, j), *front = wind.v.row(k, j), *back = wind.v.row(k, j + 1);
      const float *low = wind.w.row(k, j), *high = wind.w.row(k + 1, j);
      for (Index i = 0; i < l.nx; i += coarsening, to += 3) {
        to[0] = across * (u[i] + u[i + 1]);
        to[1] = across * (front[i] + back[i]);
        to[2] = upward * (low[i] + high[i]);
      }
    }
  });
}

/// Returns the height of a fractional level, m above ground.
float Drift::height(float level) const {
  const auto low = static_cast<std::size_t>(
      std::clamp(static_cast<Index>(level), Index{0}, std::max(shape_.nz - 2, Index{0})));
  const double gap = low + 1 < middle_.size() ? middle_[low + 1] - middle_[low] : 0.0;
  return static_cast<float>(middle_[low] +
                            gap * (static_cast<double>(level) - static_cast<double>(low)));
}

void Drift::carry(double dt, Index k) {
  const LinearInterpolator<3> speed(shape_.nx, shape_.ny, shape_.nz, speed_.data());
  const LinearInterpolator<parts> drift(shape_.nx, shape_.ny, shape_.nz, values_.data());
  const auto step = static_cast<float>(dt);
  const auto gap = static_cast<float>(solver_->lattice().spacing * static_cast<double>(coarsening));
  const auto top = static_cast<float>(shape_.nz - 1), z = static_cast<float>(k);
  const float here = height(z), half = 0.5F * step;
  float* out = next_.data() + static_cast<Index>(parts) * k * shape_.ny * shape_.nx;
  const float* now = speed_.data() + 3 * k * shape_.ny * shape_.nx;
  for (Index j = 0; j < shape_.ny; ++j) {
    for (Index i = 0; i < shape_.nx; ++i, out += parts, now += 3) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      const auto s = speed.at(x - half * now[0], y - half * now[1], z - half * now[2]);
      const float level = std::clamp(z - step * s[2], 0.0F, top);
      const auto from = drift.at(x - step * s[0], y - step * s[1], level);
      const std::array<float, 3> moved{step * s[0] * gap, step * s[1] * gap, here - height(level)};
      for (std::size_t c = 0; c < parts; ++c) {
        out[c] = from[c] + moved[c % 3];
      }
    }
  }
}

void Drift::advance() {
  const double dt = solver_->time() - time_;
  if (dt <= 0.0) {
    return;
  }
  find_speed();
  each(shape_.nz, [&](Index k) { carry(dt, k); });
  values_.swap(next_);
  time_ = solver_->time();
  const auto turns = turns_at(time_);
  for (std::size_t p = 0; p < phases; ++p) {
    if (turns[p] != turns_[p]) {
      for (std::size_t n = 0; n < shape_.size(); ++n) {
        std::fill_n(values_.begin() + static_cast<Index>(parts * n + 3 * p), 3, 0.0F);
      }
    }
  }
  turns_ = turns;
}

void Drift::restore(double time, std::span<const float> values) {
  if (values.size() != values_.size()) {
    throw std::invalid_argument(
        "the values of the drift must have the shape of this solver's grid");
  }
  std::copy(values.begin(), values.end(), values_.begin());
  time_ = time;
  turns_ = turns_at(time);
}

} // namespace firetwin::flow
