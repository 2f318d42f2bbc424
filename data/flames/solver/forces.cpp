#include "forces.hpp"

#include "noise.hpp"

namespace flame_solver {
namespace {

constexpr float carried = 0.7F;     ///< added mass of rising hot gas over its own (by eye)
constexpr float ground_drag = 1.5F; ///< 1 / time, in the lowest cells (by eye)
constexpr float fuel_drag = 5.0F;   ///< 1 / length, times the speed (by eye)
constexpr float gust_size = 0.35F, gust_height = 0.6F; ///< units (by eye)
constexpr float eddy_size = 0.12F;                     ///< units; half of it as well (by eye)
constexpr float eddy_rise = 0.8F;                      ///< speed at which small eddies move up
constexpr float eddy_least = 0.25F;                    ///< temperature below which none are made
constexpr float vortex_least = 0.05F;

void add_buoyancy(Grid& w, const Grid& temperature, float duration) {
  for (int k = 1; k < temperature.nz; ++k) {
    for (int j = 0; j < temperature.ny; ++j) {
      for (int i = 0; i < temperature.nx; ++i) {
        const float hot = 0.5F * (temperature(i, j, k) + temperature(i, j, k - 1));
        w(i, j, k) += duration * hot / (1.0F + carried * hot);
      }
    }
  }
}

/// Slows the air among fuel, implicitly.
void add_fuel_drag(Velocity& f, const Grid& fuel, float duration) {
  constexpr float none = 0.01F;
  for_each(fuel, [&](int i, int j, int k) {
    const float share = fuel(i, j, k);
    if (share > none) {
      const float u = f.u(i, j, k), v = f.v(i, j, k), w = f.w(i, j, k);
      const float speed = std::sqrt(u * u + v * v + w * w);
      const float kept = 1.0F / (1.0F + duration * fuel_drag * share * speed);
      f.u(i, j, k) *= kept;
      f.v(i, j, k) *= kept;
      f.w(i, j, k) *= kept;
    }
  });
}

void add_ground_drag(Velocity& f, const Settings& s, float duration) {
  const float kept = 1.0F / (1.0F + duration * ground_drag);
  const float slow = 0.5F * wind_speed(s, 0.5F / static_cast<float>(s.cells));
  for (int j = 0; j < s.ny; ++j) {
    for (int i = 0; i < s.nx; ++i) {
      f.u(i, j, 0) = f.u(i, j, 0) * kept + slow * (1.0F - kept);
      f.v(i, j, 0) *= kept;
    }
  }
}

/// Eddies of the air, where the wind enters, or everywhere if there is none.
void add_gusts(Velocity& f, const Settings& s, float time, float duration) {
  const float cell = 1.0F / static_cast<float>(s.cells), along = static_cast<float>(s.ny) * cell;
  const bool windy = s.wind > 0.0F;
  const int begin = windy ? 2 : 0, end = windy ? static_cast<int>(gust_size / cell) : s.nx;
  const int period = std::max(1, static_cast<int>(std::lround(along / gust_size)));
  const float strength = duration * 2.0F * s.gusts * (windy ? 3.0F * s.wind : gust_size);
  const float drift = time * (s.wind + 0.2F) / gust_size,
              y_scale = static_cast<float>(period) / along;
  for (int k = 0; k < s.nz; ++k) {
    const float z = static_cast<float>(k) * cell, amount = strength * std::exp(-z / gust_height);
    const float up = z / 0.3F;
    for (int j = 0; j < s.ny; ++j) {
      const float y = static_cast<float>(j) * cell * y_scale;
      for (int i = begin; i < end; ++i) {
        const float x = static_cast<float>(i) * cell / gust_size - drift;
        f.v(i, j, k) += amount * noise(x, y, up + 0.7F * time, period, noise_seed(s, 9));
        f.u(i, j, k) += amount * noise(x, y, up - 0.6F * time, period, noise_seed(s, 10));
        if (k > 0) {
          f.w(i, j, k) += 0.6F * amount * noise(x, y, up - 0.6F * time, period, noise_seed(s, 11));
        }
      }
    }
  }
}

/// Adds random forces in hot gas: eddies that the gradients of density in thin sheets would make,
/// which a pressure of uniform density leaves out.
void add_small_eddies(Velocity& f, const Grid& temperature, const Settings& s, float time,
                      float duration) {
  const float cell = 1.0F / static_cast<float>(s.cells), along = static_cast<float>(s.ny) * cell;
  const int period = std::max(1, static_cast<int>(std::lround(along / eddy_size)));
  const float scale = cell / eddy_size, y_scale = static_cast<float>(period) / along * cell;
  const auto both = [&](float x, float y, float z, std::uint32_t number) {
    return noise(x, y, z, period, noise_seed(s, number)) +
           noise(2.0F * x, 2.0F * y, 2.0F * z, 2 * period, noise_seed(s, number + 3));
  };
  for (int k = 1; k < s.nz - 1; ++k) {
    const float z = (static_cast<float>(k) * cell - eddy_rise * time) / eddy_size;
    for (int j = 0; j < s.ny; ++j) {
      const float y = static_cast<float>(j) * y_scale;
      for (int i = 1; i < s.nx - 1; ++i) {
        const float hot = temperature(i, j, k);
        if (hot < eddy_least) {
          continue;
        }
        const float x = static_cast<float>(i) * scale;
        const float amount = duration * s.eddies * hot / (1.0F + hot);
        f.u(i, j, k) += amount * both(x, y, z, 12);
        f.v(i, j, k) += amount * both(x, y, z, 18);
        f.w(i, j, k) += amount * both(x, y, z, 24);
      }
    }
  }
}

/// Vorticity, and its magnitude, at cells that are not at an end of the box; times a cell.
struct Vorticity {
  Grid x, y, z, size;
  explicit Vorticity(const Velocity& f) : x(f.v.nx, f.v.ny, f.v.nz), y(x), z(x), size(x) {
    const Grid &u = f.u, &v = f.v, &w = f.w;
    for (int k = 1; k < x.nz - 1; ++k) {
      for (int j = 0; j < x.ny; ++j) {
        const int m = before(j, x.ny), q = after(j, x.ny);
        for (int i = 1; i < x.nx - 1; ++i) {
          const float w_y = w(i, q, k) + w(i, q, k + 1) - w(i, m, k) - w(i, m, k + 1);
          const float w_x =
              w(i + 1, j, k) + w(i + 1, j, k + 1) - w(i - 1, j, k) - w(i - 1, j, k + 1);
          const float v_z = v(i, j, k + 1) + v(i, q, k + 1) - v(i, j, k - 1) - v(i, q, k - 1);
          const float v_x = v(i + 1, j, k) + v(i + 1, q, k) - v(i - 1, j, k) - v(i - 1, q, k);
          const float u_z =
              u(i, j, k + 1) + u(i + 1, j, k + 1) - u(i, j, k - 1) - u(i + 1, j, k - 1);
          const float u_y = u(i, q, k) + u(i + 1, q, k) - u(i, m, k) - u(i + 1, m, k);
          const float a = 0.25F * (w_y - v_z), b = 0.25F * (u_z - w_x), c = 0.25F * (v_x - u_y);
          x(i, j, k) = a;
          y(i, j, k) = b;
          z(i, j, k) = c;
          size(i, j, k) = std::sqrt(a * a + b * b + c * c);
        }
      }
    }
  }
};

/// Confines vortices in hot gas (Steinhoff and Underhill 1994): eps h N x omega.
void confine_vortices(Velocity& f, const Grid& temperature, float strength, float duration) {
  const Vorticity o(f);
  const Grid& size = o.size;
  const float amount = strength * duration;
  for (int k = 2; k < size.nz - 2; ++k) {
    for (int j = 0; j < size.ny; ++j) {
      const int m = before(j, size.ny), q = after(j, size.ny);
      for (int i = 2; i < size.nx - 2; ++i) {
        if (temperature(i, j, k) < vortex_least) {
          continue;
        }
        const float a = size(i + 1, j, k) - size(i - 1, j, k), b = size(i, q, k) - size(i, m, k),
                    c = size(i, j, k + 1) - size(i, j, k - 1);
        const float n = amount / (std::sqrt(a * a + b * b + c * c) + 1.0e-6F);
        f.u(i, j, k) += n * (b * o.z(i, j, k) - c * o.y(i, j, k));
        f.v(i, j, k) += n * (c * o.x(i, j, k) - a * o.z(i, j, k));
        f.w(i, j, k) += n * (a * o.y(i, j, k) - b * o.x(i, j, k));
      }
    }
  }
}

} // namespace

float wind_speed(const Settings& settings, float height) {
  return settings.wind * std::pow(std::clamp(height, 0.02F, 1.0F) / 0.5F, 0.3F);
}

void add_forces(Velocity& flow, const Grid& temperature, const Grid& fuel, const Settings& s,
                float time, float duration) {
  add_buoyancy(flow.w, temperature, duration);
  add_fuel_drag(flow, fuel, duration);
  add_ground_drag(flow, s, duration);
  add_gusts(flow, s, time, duration);
  add_small_eddies(flow, temperature, s, time, duration);
  confine_vortices(flow, temperature, s.confinement, duration);
}

} // namespace flame_solver
