#include "run/plane.hpp"

#include "run/grid_file.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace firetwin::run {
namespace {

constexpr std::size_t part = 1U << 16U; ///< number of values that fit the processor's cache

} // namespace

Plane::Plane(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
             std::optional<float> no_data, double zero)
    : rows_(rows), columns_(columns), no_data_(no_data), zero_(zero) {
  if (path.extension() == ".npy") {
    file_.emplace(path);
    if (!file_->scattered() && file_->shape() == std::vector<std::size_t>{rows, columns}) {
      return;
    }
    file_.reset();
  }
  values_.resize(rows * columns);
  if (zero_ == 0.0) {
    read_grid(path, rows, columns, no_data, values_);
  } else {
    narrow(read_double_grid(path, rows, columns).values, values_);
  }
}

Plane::Plane(Make make, std::size_t rows, std::size_t columns)
    : rows_(rows), columns_(columns), make_(std::move(make)) {}

std::size_t Plane::rows_at_once() const {
  return std::max<std::size_t>(part / columns_, 1);
}

std::vector<float> Plane::read_all() const {
  if (make_) {
    return make_();
  }
  std::vector<float> values(rows_ * columns_);
  read_file(0, values);
  return values;
}

void Plane::read_file(std::size_t first, std::span<float> out) const {
  if (zero_ == 0.0) {
    file_->read(first, out);
    blank(out, no_data_);
    return;
  }
  std::vector<double> values(out.size());
  file_->read(first, values);
  narrow(values, out);
}

void Plane::narrow(std::span<const double> values, std::span<float> out) const {
  std::transform(values.begin(), values.end(), out.begin(), [this](double value) {
    const bool none = no_data_ && static_cast<float>(value) == *no_data_;
    return none ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value - zero_);
  });
}

const std::vector<float>& Plane::values() const {
  if (file_ || make_) {
    tbb::collaborative_call_once(once_, [this] { values_ = read_all(); });
  }
  return values_;
}

void Plane::read(std::size_t first, std::span<float> out) const {
  if (first > rows_ || out.size() > (rows_ - first) * columns_) {
    throw std::out_of_range("rows from " + std::to_string(first) + " on of a grid with " +
                            std::to_string(rows_) + " rows");
  }
  if (file_) {
    read_file(first, out);
    return;
  }
  const auto begin = values().begin() + static_cast<std::ptrdiff_t>(first * columns_);
  std::copy_n(begin, out.size(), out.begin());
}

} // namespace firetwin::run
