#pragma once

namespace firetwin::volume {

/// One buoyant plume in a stably stratified wind.
///
/// Rise after Briggs (1969, 1984), in the form of HYSPLIT's EMRISE: in transition 1.6 Fb^(1/3)
/// x^(2/3) / U; finally 2.6 (Fb / (U s))^(1/3) in wind or 5.3 Fb^(1/4) s^(-3/8) in calm air,
/// whichever is lower. A fourth-power mean joins the two phases and reaches the final rise. Fb = g
/// Q c / (pi cp rho T) in m4/s3, with the convective share c = 0.7 of the released heat Q (W); s is
/// the square of the buoyancy frequency (1/s2), x the distance downwind. (HYSPLIT's own Fb = 7.6e-7
/// Q is a tenth of this, and limits large fires to less than 2 km.)
///
/// U in Briggs's formulas is the wind 300 m above ground. Wind increases with height h as U10 (h /
/// 10 m)^0.1, the rural power law of a slightly unstable afternoon (Irwin 1979, class C).
class Plume {
public:
  /// `power` in W, `wind` at 10 m in m/s, `stability` s in 1/s2.
  Plume(double power, double wind, double stability);

  /// Returns the height above the source of smoke `age` seconds old, m.
  double rise(double age) const;
  /// Returns the distance downwind of smoke `age` seconds old, m: the integral of the wind at its
  /// height.
  double drift(double age) const;

private:
  double flux_;       ///< Fb, m4/s3
  double wind_;       ///< at 10 m, m/s
  double wind_aloft_; ///< at 300 m, m/s
  double final_rise_; ///< m
};

} // namespace firetwin::volume
