#include "run/series.hpp"

#include "geo/axis.hpp"
#include "io/name.hpp"
#include "run/grid_file.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace firetwin::run {

Series::Series(NpyFile file, std::size_t rows, std::size_t columns, std::optional<float> no_data)
    : file_(std::move(file)), rows_(rows), columns_(columns), no_data_(no_data) {
  const auto& shape = file_->shape();
  if (shape.size() != 3 || shape[0] == 0 || shape[1] != rows || shape[2] != columns) {
    io::fail(file_->path(), "expected shape (times, " + std::to_string(rows) + ", " +
                                std::to_string(columns) + "), found " + shape_text(shape) +
                                "; make the field fit the axes");
  }
}

Series::Series(std::vector<std::filesystem::path> frames, std::size_t rows, std::size_t columns,
               std::optional<float> no_data)
    : frames_(std::move(frames)), rows_(rows), columns_(columns), no_data_(no_data) {}

Series Series::onto(std::vector<double> from_y, std::vector<double> from_x,
                    std::vector<double> to_y, std::vector<double> to_x) && {
  axes_ = Axes{std::move(from_y), std::move(from_x), std::move(to_y), std::move(to_x)};
  return std::move(*this);
}

const std::filesystem::path& Series::path(std::size_t index) const {
  return file_ ? file_->path() : frames_.at(index);
}

void Series::read(std::size_t index, std::span<float> out) const {
  if (index >= size()) {
    throw std::out_of_range("time index " + std::to_string(index) + " of a run with " +
                            std::to_string(size()) + " times");
  }
  if (!axes_) {
    read_own(index, out);
    return;
  }
  std::vector<float> own(rows_ * columns_);
  read_own(index, own);
  const auto found = geo::resample(own, axes_->from_y, axes_->from_x, axes_->to_y, axes_->to_x);
  std::copy(found.begin(), found.end(), out.begin());
}

void Series::read_own(std::size_t index, std::span<float> out) const {
  if (!file_) {
    read_grid(frames_[index], rows_, columns_, no_data_, out);
    return;
  }
  file_->read(index, out);
  blank(out, no_data_);
}

} // namespace firetwin::run
