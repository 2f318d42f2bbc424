#pragma once

namespace firetwin::volume {

/// One buoyant plume in a stably stratified wind.
///
/// Rise after Briggs (1969, 1984), the form of HYSPLIT's EMRISE: in transition
/// 1.6 Fb^(1/3) x^(2/3) / U, finally 2.6 (Fb / (U s))^(1/3), or 5.3 Fb^(1/4) s^(-3/8) in a calm,
/// whichever is lower. The two parts are joined by a fourth-power mean, which reaches the final
/// rise. Fb = g Q c / (pi cp rho T) in m4/s3, with the convective part c = 0.7 of the released heat
/// Q (W); s is the square of the buoyancy frequency (1/s2), x the distance downwind. (HYSPLIT's own
/// Fb = 7.6e-7 Q is a tenth of this and keeps large fires under 2 km.)
///
/// U in Briggs's formulas is the wind 300 m above the ground; the wind grows with height h as
/// U10 (h / 10 m)^0.1, the rural power law of a slightly unstable afternoon (Irwin 1979, class C).
class Plume {
public:
  /// `power` in W, `wind` at 10 m in m/s, `stability` s in 1/s2.
  Plume(double power, double wind, double stability);

  /// Height above the source of smoke `age` seconds old, m.
  double rise(double age) const;
  /// Distance downwind of smoke `age` seconds old, m: the integral of the wind at its own height.
  double drift(double age) const;

private:
  double flux_;       ///< Fb, m4/s3
  double wind_;       ///< at 10 m, m/s
  double wind_aloft_; ///< at 300 m, m/s
  double final_rise_; ///< m
};

} // namespace firetwin::volume
