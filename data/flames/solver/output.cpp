#include "output.hpp"

#include <stdexcept>

namespace flame_solver {
namespace {

constexpr float brightest = 4.0F; ///< mixture fraction of code 255
constexpr float burning = 0.9F;   ///< mixture fraction of gas whose rise is measured

std::uint8_t encode(float mixture) {
  const float share = std::clamp(mixture / brightest, 0.0F, 1.0F);
  return static_cast<std::uint8_t>(std::lround(255.0F * std::sqrt(share)));
}

void write_floats(std::ofstream& file, const std::vector<double>& values, double scale) {
  std::vector<float> floats;
  floats.reserve(values.size());
  for (const double value : values) {
    floats.push_back(static_cast<float>(value * scale));
  }
  file.write(reinterpret_cast<const char*>(floats.data()),
             static_cast<std::streamsize>(floats.size() * sizeof(float)));
}

/// Heat that leaves through the sides and the top: speed times T / (1 + T), summed over faces.
double heat_outflow(const Flame& flame) {
  const Grid& hot = flame.temperature();
  const Velocity& flow = flame.flow();
  const int end = hot.nx - 1, top = hot.nz - 1;
  double sum = 0.0;
  const auto add = [&](float speed, float excess) {
    sum += static_cast<double>(speed * excess / (1.0F + excess));
  };
  for (int j = 0; j < hot.ny; ++j) {
    for (int k = 0; k < hot.nz; ++k) {
      add(flow.u(hot.nx, j, k), hot(end, j, k));
      add(-flow.u(0, j, k), hot(0, j, k));
    }
    for (int i = 0; i < hot.nx; ++i) {
      add(flow.w(i, j, hot.nz), hot(i, j, top));
    }
  }
  return sum;
}

} // namespace

Output::Output(const Settings& s) : path_(s.out), frames_(s.out, std::ios::binary), settings_(s) {
  const auto levels = static_cast<std::size_t>(s.nz);
  rise_.resize(levels);
  hot_cells_.resize(levels);
}

void Output::add(const Flame& flame) {
  const std::vector<float>& values = flame.mixture().values;
  codes_.resize(values.size());
  std::transform(values.begin(), values.end(), codes_.begin(), encode);
  frames_.write(reinterpret_cast<const char*>(codes_.data()),
                static_cast<std::streamsize>(codes_.size()));
  add_profiles(flame);
  heat_ += heat_outflow(flame);
  divergence_ = std::max(divergence_, divergence_error(flame.flow(), flame.expansion()));
  ++count_;
}

void Output::add_profiles(const Flame& flame) {
  for_each(flame.mixture(), [&](int i, int j, int k) {
    const auto level = static_cast<std::size_t>(k);
    if (flame.mixture()(i, j, k) > burning) {
      rise_[level] += static_cast<double>(flame.flow().w(i, j, k));
      hot_cells_[level] += 1.0;
    }
  });
}

void Output::close() {
  std::ofstream file(path_ + ".profiles", std::ios::binary);
  const double share = 1.0 / (static_cast<double>(count_) * settings_.ny);
  for (std::size_t k = 0; k < rise_.size(); ++k) {
    rise_[k] /= std::max(1.0, hot_cells_[k]);
  }
  write_floats(file, {heat_}, share / settings_.cells);
  write_floats(file, rise_, 1.0);
  write_floats(file, {divergence_}, 1.0);
  frames_.close();
  file.close();
  if (!frames_ || !file) {
    throw std::runtime_error(path_ + ": could not be written");
  }
}

} // namespace flame_solver
