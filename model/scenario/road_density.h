// Density and coherence of a road's roughness over the wave number n [1/m].
#pragma once

namespace strut {

/// Returns the two-sided density of a track's height for G0 = 1 m^3 [m^3]: (n / n0)^-2 / 2,
/// n0 = 0.1 1/m (ISO 8608).
double calc_height_density(double wave_number);

/// Returns the coherence of two tracks `width` [m] apart: 0.9 times that of an isotropic road,
/// x K_1(x), x = 2 pi n width (C. J. Dodds, J. D. Robson, J. Sound Vib. 31 (1973)), since no real
/// road is isotropic.
double calc_track_coherence(double wave_number, double width);

}  // namespace strut
