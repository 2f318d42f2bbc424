#include "sensor/palette.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace firetwin::sensor {
namespace {

constexpr std::array<Colour, 2> white_hot = {{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}};
constexpr std::array<Colour, 2> black_hot = {{{1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}}};
constexpr std::array<Colour, 8> ironbow = {{{0.0, 0.0, 0.04},
                                            {0.16, 0.0, 0.46},
                                            {0.50, 0.0, 0.61},
                                            {0.76, 0.08, 0.50},
                                            {0.91, 0.30, 0.13},
                                            {0.98, 0.58, 0.0},
                                            {1.0, 0.86, 0.22},
                                            {1.0, 1.0, 0.97}}};
constexpr std::array<Colour, 17> inferno = {{{0.0015, 0.0005, 0.0139},
                                             {0.0423, 0.0281, 0.1411},
                                             {0.1293, 0.0473, 0.2908},
                                             {0.2383, 0.0366, 0.3964},
                                             {0.3415, 0.0623, 0.4294},
                                             {0.4412, 0.0993, 0.4316},
                                             {0.5409, 0.1347, 0.4151},
                                             {0.6401, 0.1714, 0.3811},
                                             {0.7357, 0.2159, 0.3302},
                                             {0.8224, 0.2752, 0.2661},
                                             {0.8943, 0.3534, 0.1936},
                                             {0.9470, 0.4492, 0.1153},
                                             {0.9784, 0.5579, 0.0349},
                                             {0.9879, 0.6753, 0.0653},
                                             {0.9746, 0.7977, 0.2063},
                                             {0.9476, 0.9174, 0.4107},
                                             {0.9884, 0.9984, 0.6449}}};
constexpr std::array<Colour, 6> paper = {{{0.0, 0.0, 0.0},
                                          {0.5, 0.0, 0.5},
                                          {1.0, 0.0, 0.0},
                                          {1.0, 0.5, 0.0},
                                          {1.0, 1.0, 0.0},
                                          {1.0, 1.0, 1.0}}};
constexpr std::array<Palette, 5> known = {{{"white-hot", white_hot},
                                           {"black-hot", black_hot},
                                           {"ironbow", ironbow},
                                           {"inferno", inferno},
                                           {"paper", paper}}};

} // namespace

Colour Palette::at(double fraction) const {
  const auto last = static_cast<double>(stops.size() - 1);
  const double place = std::clamp(fraction, 0.0, 1.0) * last;
  const double lower = std::min(std::floor(place), last - 1.0);
  const auto i = static_cast<std::size_t>(lower);
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = stops[i][c] + (place - lower) * (stops[i + 1][c] - stops[i][c]);
  }
  return colour;
}

const Palette& palette(std::string_view name) {
  const auto* const found = std::ranges::find(known, name, &Palette::name);
  if (found == known.end()) {
    throw std::invalid_argument("no palette is called \"" + std::string(name) + "\"");
  }
  return *found;
}

std::vector<std::string> palettes() {
  std::vector<std::string> names;
  for (const Palette& each : known) {
    names.emplace_back(each.name);
  }
  return names;
}

void colour(std::span<const float> kelvin, double low, double high, double knee,
            const Palette& palette, std::span<float> colour) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high)) {
    throw std::invalid_argument("low and high must be finite temperatures in K, low below high");
  }
  if (!(knee >= 0.0) || !std::isfinite(knee)) {
    throw std::invalid_argument("knee must be 0 or more");
  }
  const double range = high - low;
  const double scale = knee > 0.0 ? 1.0 / std::log1p(range / knee) : 1.0 / range;
  for (std::size_t i = 0; i < kelvin.size(); ++i) {
    const double above = static_cast<double>(kelvin[i]) - low;
    const double held = above > 0.0 ? std::min(above, range) : 0.0; // NaN: low
    const Colour shown = palette.at(scale * (knee > 0.0 ? std::log1p(held / knee) : held));
    for (std::size_t c = 0; c < 3; ++c) {
      colour[3 * i + c] = static_cast<float>(shown[c]);
    }
  }
}

} // namespace firetwin::sensor
