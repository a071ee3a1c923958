// J'J of a network without J: the sums, and their places in H.
//
// The row of J for sample n and output k is, in layer l, delta_l^k (x) [a_(l-1); 1]. So
//   H(l, l') = sum_n (sum_k delta_l^k delta_l'^k') (x) (a a')
// is one matrix product U' V per pair of layers, with U_n = vec(sum_k delta delta') and
// V_n = vec(a a'): the sum over the outputs precedes the product. For a layer paired with itself,
// both factors are symmetric and only i >= j and p >= q are computed.
// Prior art: B. M. Wilamowski, H. Yu, IEEE Trans. Neural Networks 21 (2010) 930 (J'J without J);
// M. Fairbank, E. Alonso, Neural Computation 24 (2012) 607 (a factor of the number of outputs).
#pragma once

#include <cstddef>
#include <vector>

#include "train/network/shape.h"

namespace strut {

/// Rows of the product of a pair of layers, `first` <= `second`.
struct GramTile {
  std::size_t first = 0, second = 0;  // layers
  std::size_t first_row = 0;          // first row of U' (pair of neurons)
  std::size_t rows = 0;
  std::size_t columns = 0;  // pairs of inputs, including biases
  std::size_t offset = 0;   // first entry of the tile in the sums; stored by columns, `rows` apart
};

/// The products of all pairs of layers, cut into tiles of similar cost. The cut depends on the
/// shape alone, so that results do not depend on which thread computes which tile.
struct GramLayout {
  explicit GramLayout(const NetworkShape& shape);

  std::vector<GramTile> tiles;  // most expensive first
  std::size_t sum_count = 0;
  std::size_t largest_factors = 0;  // maximum of rows + columns over the tiles
};

/// Number of pairs of neurons of a pair of layers: rows of U'.
std::size_t count_neuron_pairs(const NetworkShape& shape, std::size_t first, std::size_t second);

/// Writes a tile's sums into the lower triangle of H (n x n, by columns), n = shape.weight_count.
void store_tile(const NetworkShape& shape, const GramTile& tile, const double* sums, double* h);

}  // namespace strut
