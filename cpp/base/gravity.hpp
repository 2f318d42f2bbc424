#pragma once

namespace firetwin {

/// Standard gravity, m/s2 (3rd General Conference on Weights and Measures, 1901). Round figures
/// such as 9.81 differ by less than gravity itself does: 9.796 in the Rubicon canyon by latitude
/// and height.
constexpr double gravity = 9.80665;

} // namespace firetwin
