// Density and coherence of a road's roughness over the wave number n [1/m].
#pragma once

namespace strut {

/// Two-sided density of a track's slope for G0 = 1 m^3, n0 = 0.1 1/m: white [1/m].
double calc_slope_density(double wave_number);

/// How alike two tracks of an isotropic road are, `width` [m] apart: x K_1(x), x = 2 pi n width
/// (C. J. Dodds, J. D. Robson, J. Sound Vib. 31 (1973)), reduced to kTrustedCoherence of it, since
/// no road is isotropic.
double calc_track_coherence(double wave_number, double width);

}  // namespace strut
