#include "flow/drift.hpp"

#include "base/check.hpp"
#include "flow/between.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flow {
namespace {

std::size_t cells(const Lattice& l) {
  return static_cast<std::size_t>(l.nz * l.ny * l.nx);
}

/// Height of a fractional level, m.
float height(const Lattice& l, float level) {
  const auto low = std::clamp(static_cast<Index>(level), Index{0}, std::max(l.nz - 2, Index{0}));
  const auto k = static_cast<std::size_t>(low);
  const double above = low + 1 < l.nz ? l.middle[k + 1] - l.middle[k] : 0.0;
  return static_cast<float>(l.middle[k] +
                            above * (static_cast<double>(level) - static_cast<double>(low)));
}

} // namespace

Drift::Drift(std::shared_ptr<const Solver> solver, double period)
    : solver_(std::move(solver)), period_(period), time_(solver_->time()) {
  check_above_zero(period, "period");
  turns_ = turns_at(time_);
  const std::size_t n = cells(lattice());
  speed_.resize(3 * n);
  values_.resize(parts * n);
  next_.resize(parts * n);
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
  const Lattice& l = lattice();
  const Wind& wind = solver_->state().wind;
  const auto across = static_cast<float>(0.5 / l.spacing);
  each(l.nz, [&](Index k) {
    const auto upward = static_cast<float>(0.5 / l.depth[static_cast<std::size_t>(k)]);
    float* to = speed_.data() + 3 * k * l.ny * l.nx;
    for (Index j = 0; j < l.ny; ++j) {
      const float *u = wind.u.row(k, j), *front = wind.v.row(k, j), *back = wind.v.row(k, j + 1);
      const float *low = wind.w.row(k, j), *high = wind.w.row(k + 1, j);
      for (Index i = 0; i < l.nx; ++i, to += 3) {
        to[0] = across * (u[i] + u[i + 1]);
        to[1] = across * (front[i] + back[i]);
        to[2] = upward * (low[i] + high[i]);
      }
    }
  });
}

void Drift::carry(double dt, Index k, std::vector<float>& to) const {
  const Lattice& l = lattice();
  const Between<3> speed(l.nx, l.ny, l.nz, speed_.data());
  const Between<parts> drift(l.nx, l.ny, l.nz, values_.data());
  const auto step = static_cast<float>(dt), cell = static_cast<float>(l.spacing);
  const auto here = static_cast<float>(l.middle[static_cast<std::size_t>(k)]);
  const auto top = static_cast<float>(l.nz - 1);
  float* out = to.data() + parts * k * l.ny * l.nx;
  const float* now = speed_.data() + 3 * k * l.ny * l.nx;
  for (Index j = 0; j < l.ny; ++j) {
    for (Index i = 0; i < l.nx; ++i, out += parts, now += 3) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j), z = static_cast<float>(k);
      const float half = 0.5F * step;
      const auto s = speed.at(x - half * now[0], y - half * now[1], z - half * now[2]);
      const float level = std::clamp(z - step * s[2], 0.0F, top);
      const auto from = drift.at(x - step * s[0], y - step * s[1], level);
      const std::array<float, 3> moved{step * s[0] * cell, step * s[1] * cell,
                                       here - height(l, level)};
      for (std::size_t c = 0; c < parts; ++c) {
        out[c] = from[c] + moved[c % 3];
      }
    }
  }
}

void Drift::advance() {
  const Lattice& l = lattice();
  const double dt = solver_->time() - time_;
  if (dt <= 0.0) {
    return;
  }
  find_speed();
  each(l.nz, [&](Index k) { carry(dt, k, next_); });
  values_.swap(next_);
  time_ = solver_->time();
  const auto turns = turns_at(time_);
  for (std::size_t p = 0; p < phases; ++p) {
    if (turns[p] != turns_[p]) {
      for (std::size_t n = 0; n < cells(l); ++n) {
        std::fill_n(values_.begin() + static_cast<Index>(parts * n + 3 * p), 3, 0.0F);
      }
    }
  }
  turns_ = turns;
}

void Drift::restore(double time, std::span<const float> values) {
  if (values.size() != values_.size()) {
    throw std::invalid_argument("the drift's values belong to another grid");
  }
  std::copy(values.begin(), values.end(), values_.begin());
  time_ = time;
  turns_ = turns_at(time);
}

} // namespace firetwin::flow
