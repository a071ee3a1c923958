#include "base/least_squares/damped_system.h"

#include <algorithm>

#include "base/parallel/team.h"

namespace strut {
namespace {

/// Width of a panel; measured: docs/design/0007-levenberg-marquardt.md.
constexpr std::size_t kPanel = 96;

}  // namespace

DampedSystem::DampedSystem(std::size_t size, int threads, const CholeskyKernel& kernel)
    : size_(size), threads_(threads), kernel_(&kernel), lower_(size * size) {}

void DampedSystem::copy(const std::vector<double>& h, const std::vector<double>& scale,
                        double damping) {
  share_items(threads_, (size_ + kPanel - 1) / kPanel, [&](std::size_t panel, int) {
    const std::size_t end = std::min(size_, (panel + 1) * kPanel);
    for (std::size_t column = panel * kPanel; column < end; ++column) {
      const std::size_t start = column * size_ + column;
      std::copy_n(h.data() + start, size_ - column, lower_.data() + start);
      lower_[start] += damping * scale[column];
    }
  });
}

bool DampedSystem::factor(const std::vector<double>& h, const std::vector<double>& scale,
                          double damping) {
  copy(h, scale, damping);
  double* a = lower_.data();
  const std::size_t n = size_;
  for (std::size_t k = 0; k < n; k += kPanel) {
    const std::size_t width = std::min(kPanel, n - k), next = k + width;
    if (!kernel_->factor_diagonal(a + k * n + k, width, n)) return false;
    const std::size_t panels = (n - next + kPanel - 1) / kPanel;
    share_items(threads_, panels, [&](std::size_t p, int) {
      const std::size_t row = next + p * kPanel;
      kernel_->solve_panel(a + k * n + k, width, a + k * n + row, std::min(kPanel, n - row), n);
    });
    // The panels shrink to the right, so ascending order starts with the largest.
    share_items(threads_, panels, [&](std::size_t p, int) {
      const std::size_t at = next + p * kPanel;
      kernel_->update_panel(a + k * n + at, a + k * n + at, a + at * n + at, n - at,
                            std::min(kPanel, n - at), width, n);
    });
  }
  return true;
}

void DampedSystem::solve(std::vector<double>& x) const {
  kernel_->solve(lower_.data(), size_, x.data());
}

}  // namespace strut
