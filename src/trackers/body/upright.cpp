#include "trackers/body/upright.h"

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"

namespace duo::body {
namespace {

constexpr double kSameRun_m = 0.25, kSameBlob_m = 0.2, kNoise_px = 1;

bool has_depth(std::uint16_t q4) { return q4 != Disparity::kNone && q4 != 0; }

/// Median depth of nine places in a square; 0 where fewer than five are known.
double cell_depth(const DepthView& depth, int x0, int y0, int side) {
  std::array<double, 9> found;
  std::size_t count = 0;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const int x = x0 + (2 * i + 1) * side / 6, y = y0 + (2 * j + 1) * side / 6;
      if (x >= depth.d_q4.width() || y >= depth.d_q4.height()) continue;
      if (const std::uint16_t q4 = depth.d_q4.at(y, x); has_depth(q4)) found[count++] = depth.z_m(q4);
    }
  return count < 5 ? 0 : median(std::span(found.data(), count));
}

}  // namespace

void Uprights::read_cells(const DepthView& depth) {
  const Size size = depth.d_q4.size();
  side_px_ = std::max({(size.width + kColumns - 1) / kColumns, (size.height + kMostRows - 1) / kMostRows, 1});
  columns_ = std::min(size.width / side_px_, kColumns);
  rows_ = std::min(size.height / side_px_, kMostRows);
  for (int column = 0; column < columns_; ++column)
    for (int row = 0; row < rows_; ++row) z_m_[column][row] = cell_depth(depth, column * side_px_, row * side_px_, side_px_);
}

std::span<const Uprights::Run> Uprights::runs_of(const DepthView& depth, int column) {
  constexpr double kLeast_m = 0.5;
  constexpr int kGap = 2;  // cells without depth
  std::size_t count = 0;
  Run run;
  int cells = 0;
  const auto end = [&] {
    const double height_m = (run.bottom - run.top + 1) * side_px_ / depth.px_per_m(std::max(run.z_m, 0.1));
    if (cells > 0 && height_m > kLeast_m && count < runs_.size()) runs_[count++] = run;
    cells = 0;
  };
  for (int row = 0; row < rows_; ++row) {
    const double z = z_m_[column][row];
    if (z == 0) {
      if (cells > 0 && row - run.bottom > kGap) end();
      continue;
    }
    if (cells > 0 && std::abs(z - run.z_m) > kSameRun_m + kNoise_px * depth.m_per_px(z)) end();
    if (cells == 0) run = {row, row, 0};
    run.z_m += (z - run.z_m) / ++cells;
    run.bottom = row;
  }
  end();
  return {runs_.data(), count};
}

void Uprights::add(int column, const Run& run) {
  for (std::size_t i = 0; i < blob_count_; ++i) {
    Blob& blob = blobs_[i];
    const int both = std::min(run.bottom, blob.last.bottom) - std::max(run.top, blob.last.top) + 1;
    const int least = std::min(run.bottom - run.top, blob.last.bottom - blob.last.top) + 1;
    if (blob.right != column - 1 || 2 * both < least || std::abs(blob.last.z_m - run.z_m) > kSameBlob_m) continue;
    blob.right = column;
    blob.top = std::min(blob.top, run.top);
    blob.bottom = std::max(blob.bottom, run.bottom);
    blob.z_sum_m += run.z_m;
    blob.last = run;
    ++blob.runs;
    return;
  }
  blobs_[blob_count_++] = {column, column, run.top, run.bottom, 1, run.z_m, run};
}

bool Uprights::is_person_sized(const DepthView& depth, const Blob& blob) const {
  constexpr double kNarrow_m = 0.2, kWide_m = 1.1, kHigh_m = 1, kCutHigh_m = 0.6, kFar_m = 6;
  const double z = blob.z_sum_m / blob.runs, cell_m = side_px_ / depth.px_per_m(z);
  const double width_m = (blob.right - blob.left + 1) * cell_m, height_m = (blob.bottom - blob.top + 1) * cell_m;
  const bool cut = blob.top == 0 || blob.bottom == rows_ - 1;
  return z < kFar_m && width_m > kNarrow_m && width_m < kWide_m && height_m > (cut ? kCutHigh_m : kHigh_m);
}

bool Uprights::is_farther(const Blob& blob, int from, int to) const {
  constexpr double kApart_m = 0.3;
  const double z = blob.z_sum_m / blob.runs;
  int farther = 0, known = 0;
  for (int column = std::max(from, 0); column <= std::min(to, columns_ - 1); ++column)
    for (int row = blob.top; row <= blob.bottom; ++row) {
      known += z_m_[column][row] > 0;
      farther += z_m_[column][row] > z + kApart_m;
    }
  return 2 * farther > known;
}

std::span<const Upright> Uprights::find(const DepthView& depth) {
  read_cells(depth);
  blob_count_ = 0;
  for (int column = 0; column < columns_; ++column)
    for (const Run& run : runs_of(depth, column)) add(column, run);
  std::size_t count = 0;
  for (std::size_t i = 0; i < blob_count_; ++i) {
    const Blob& blob = blobs_[i];
    constexpr int kBeside = 3;  // of the nearest column the other camera may see nothing
    if (!is_person_sized(depth, blob)) continue;
    if (!is_farther(blob, blob.left - kBeside, blob.left - 1) && !is_farther(blob, blob.right + 1, blob.right + kBeside))
      continue;
    found_[count++] = {blob.z_sum_m / blob.runs,
                       {blob.left * side_px_, blob.top * side_px_, (blob.right - blob.left + 1) * side_px_,
                        (blob.bottom - blob.top + 1) * side_px_},
                       blob.top == 0};
  }
  std::sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Upright& a, const Upright& b) { return std::pair(a.z_m, a.box_px.x) < std::pair(b.z_m, b.box_px.x); });
  return {found_.data(), std::min(count, kMost)};
}

// The network looks at a square around the hips' middle, a quarter larger than the whole body.
TurnedSquare region_of(const DepthView& depth, const Upright& upright, double above_m) {
  constexpr double kHalf_m = 1.1, kHipsBelowHead_m = 0.82;
  const double px_per_m = depth.px_per_m(upright.z_m);
  const Window& box = upright.box_px;
  const auto q8 = [](double px) { return static_cast<std::int32_t>(std::lround(256 * px)); };
  return {q8(box.x + box.width / 2.0), q8(box.y + (kHipsBelowHead_m - above_m) * px_per_m), q8(kHalf_m * px_per_m), 0};
}

}  // namespace duo::body
