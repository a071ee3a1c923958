#include "train/network/gram_layout.h"

#include <algorithm>

namespace strut {
namespace {

/// Maximum rows of U' in a tile: many, since each tile builds its own V, but few enough for at
/// least a dozen tiles, which threads share. Measured: docs/design/0007-levenberg-marquardt.md.
constexpr std::size_t kMaxTileRows = 192;

std::size_t calc_triangle(std::size_t n) { return n * (n + 1) / 2; }

std::size_t count_input_pairs(const NetworkShape& shape, std::size_t first, std::size_t second) {
  const auto inputs = [&](std::size_t l) {
    return static_cast<std::size_t>(shape.layers[l].inputs) + 1;
  };
  return first == second ? calc_triangle(inputs(first)) : inputs(first) * inputs(second);
}

bool is_output(const NetworkShape& shape, std::size_t layer) {
  return layer + 1 == shape.layers.size();
}

/// The lower triangle of H; takes row and column in either order.
class LowerTriangle {
 public:
  LowerTriangle(double* h, std::size_t n) : h_(h), n_(n) {}
  void set(std::size_t a, std::size_t b, double value) {
    h_[std::min(a, b) * n_ + std::max(a, b)] = value;
  }

 private:
  double* h_;
  std::size_t n_;
};

/// Stores one row of a tile of different layers: neuron i of `a`, neuron j of `b`.
void store_row(const NetworkLayer& a, int i, const NetworkLayer& b, int j, const double* sums,
               std::size_t lead, LowerTriangle h) {
  for (int p = 0; p <= a.inputs; ++p) {
    for (int q = 0; q <= b.inputs; ++q, sums += lead) h.set(a.at(i, p), b.at(j, q), *sums);
  }
}

/// Stores one row of a tile of a layer with itself.
void store_symmetric_row(const NetworkLayer& a, int i, int j, const double* sums, std::size_t lead,
                         LowerTriangle h) {
  for (int p = 0; p <= a.inputs; ++p) {
    for (int q = 0; q <= p; ++q, sums += lead) {
      h.set(a.at(i, p), a.at(j, q), *sums);
      h.set(a.at(i, q), a.at(j, p), *sums);
    }
  }
}

/// Stores the output layer with itself: the same block for each output, zeros between outputs.
void store_output_rows(const NetworkLayer& a, const double* sums, std::size_t lead,
                       LowerTriangle h) {
  for (int i = 0; i < a.outputs; ++i) {
    store_symmetric_row(a, i, i, sums, lead, h);
    for (int j = 0; j < i; ++j) {
      for (int p = 0; p <= a.inputs; ++p) {
        for (int q = 0; q <= a.inputs; ++q) h.set(a.at(i, p), a.at(j, q), 0.0);
      }
    }
  }
}

}  // namespace

std::size_t count_neuron_pairs(const NetworkShape& shape, std::size_t first, std::size_t second) {
  if (first == second && is_output(shape, first)) return 1;  // sum_k delta delta' is the identity
  const auto outputs = [&](std::size_t l) {
    return static_cast<std::size_t>(shape.layers[l].outputs);
  };
  return first == second ? calc_triangle(outputs(first)) : outputs(first) * outputs(second);
}

GramLayout::GramLayout(const NetworkShape& shape) {
  for (std::size_t first = 0; first < shape.layers.size(); ++first) {
    for (std::size_t second = first; second < shape.layers.size(); ++second) {
      const std::size_t all = count_neuron_pairs(shape, first, second);
      const std::size_t parts = (all + kMaxTileRows - 1) / kMaxTileRows;
      for (std::size_t part = 0; part < parts; ++part) {
        GramTile tile{first, second, all * part / parts, 0, 0, sum_count};
        tile.rows = all * (part + 1) / parts - tile.first_row;
        tile.columns = count_input_pairs(shape, first, second);
        sum_count += tile.rows * tile.columns;
        largest_factors = std::max(largest_factors, tile.rows + tile.columns);
        tiles.push_back(tile);  // NOLINT(performance-inefficient-vector-operation): a few dozen
      }
    }
  }
  std::stable_sort(tiles.begin(), tiles.end(), [](const GramTile& a, const GramTile& b) {
    return a.rows * a.columns > b.rows * b.columns;
  });
}

void store_tile(const NetworkShape& shape, const GramTile& tile, const double* sums, double* h) {
  const NetworkLayer& a = shape.layers[tile.first];
  const NetworkLayer& b = shape.layers[tile.second];
  LowerTriangle lower(h, shape.weight_count);
  const double* tile_sums = sums + tile.offset;
  if (tile.first == tile.second && is_output(shape, tile.first)) {
    store_output_rows(a, tile_sums, tile.rows, lower);
    return;
  }
  std::size_t pair = 0;
  for (int i = 0; i < a.outputs; ++i) {
    const int last = tile.first == tile.second ? i : b.outputs - 1;
    for (int j = 0; j <= last; ++j, ++pair) {
      if (pair < tile.first_row || pair >= tile.first_row + tile.rows) continue;
      const double* row = tile_sums + (pair - tile.first_row);
      if (tile.first == tile.second) {
        store_symmetric_row(a, i, j, row, tile.rows, lower);
      } else {
        store_row(a, i, b, j, row, tile.rows, lower);
      }
    }
  }
}

}  // namespace strut
