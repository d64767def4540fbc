// The order of the stage: octave by octave, so that only one octave is in memory.

#include "stages/sift/sift.h"

#include <cmath>
#include <cstring>

#include "core/check.h"
#include "stages/sift/functions.h"
#include "stages/sift/kernels.h"

namespace duo {

SiftScratch::SiftScratch(Size largest_window, int capacity, const SiftParams& params)
    : places(static_cast<std::size_t>(capacity)) {
  const int more = 2 * params.margin_px + (1 << (params.octaves - 1));  // the grid of the last octave moves the corner
  const Size size = {largest_window.width + more, largest_window.height + more};
  for (auto* planes : {&blurred[0], &blurred[1], &blurred[2], &blurred[3], &blurred[4], &blurred[5]})
    *planes = Image<float>(size);
  for (auto& plane : difference) plane = Image<float>(size);
  for (auto& plane : magnitude) plane = Image<float>(size);
  for (auto& plane : turns) plane = Image<float>(size);
  for (auto& plane : marks) plane = Image<std::uint8_t>(size);
}

namespace sift {
namespace {

constexpr int kLevels = SiftScratch::kLevels, kBlurred = kLevels + 3;
constexpr double kSigma = 1.6, kCameraSigma = 0.5;  // px

BlurKernel make_kernel(double sigma) {
  BlurKernel kernel;
  kernel.radius = static_cast<int>(4 * sigma + 0.5);
  gaussian_row(1 / (2 * sigma * sigma), 0, 1, kernel.radius + 1, kernel.weight);
  double sum = kernel.weight[0];
  for (int i = 1; i <= kernel.radius; ++i) sum += 2 * double{kernel.weight[i]};
  for (int i = 0; i <= kernel.radius; ++i) kernel.weight[i] = static_cast<float>(kernel.weight[i] / sum);
  return kernel;
}

double scale_of(double level) { return kSigma * exponential(level * (0.69314718055994531 / kLevels)); }

/// What must be added to a blur of `from` to make it one of `to`.
BlurKernel kernel_between(double from, double to) { return make_kernel(std::sqrt(to * to - from * from)); }

Neighbourhood around(const SiftPoint& p, Size size, float reach, double sigma) {
  Neighbourhood n;
  n.x = p.x_px;
  n.y = p.y_px;
  const auto first = [&](float at) { return std::max(1, static_cast<int>(std::ceil(at - reach))); };
  const auto end = [&](float at, int length) { return std::min(length - 1, static_cast<int>(std::floor(at + reach)) + 1); };
  n.x_begin = first(p.x_px), n.x_end = end(p.x_px, size.width);
  n.y_begin = first(p.y_px), n.y_end = end(p.y_px, size.height);
  const double a = 1 / (2 * sigma * sigma);
  gaussian_row(a, n.x_begin - double{p.x_px}, 1, n.x_end - n.x_begin, n.x_weight);
  gaussian_row(a, n.y_begin - double{p.y_px}, kFixed, n.y_end - n.y_begin, n.y_weight);
  return n;
}

/// One call of the stage.
class Search {
 public:
  Search(const Kernels& kernels, Pool& pool, const Window& window, const SiftParams& params, SiftScratch& scratch,
         SiftPoints& out)
      : kernels_(kernels), pool_(pool), window_(window), params_(params), scratch_(scratch), out_(out) {}

  /// Corner and size of the part of the picture that is blurred.
  void start(View<const std::uint8_t> src) {
    const int grid = 1 << (params_.octaves - 1), margin = params_.margin_px;
    x0_ = std::max(0, window_.x - margin) / grid * grid;
    y0_ = std::max(0, window_.y - margin) / grid * grid;
    size_ = {std::min(src.width(), window_.x + window_.width + margin) - x0_,
             std::min(src.height(), window_.y + window_.height + margin) - y0_};
    const Size room = scratch_.blurred[0].size();
    DUO_CHECK(size_.width <= room.width && size_.height <= room.height);
    const View<float> gray = plane(scratch_.blurred[1]);
    pool_.rows(size_.height, [&](int begin, int end) {
      for (int y = begin; y < end; ++y) std::copy_n(src.row(y0_ + y) + x0_, size_.width, gray.row(y));
    });
    blur(gray, blur_of_picture(), plane(scratch_.blurred[0]), {});
    for (int level = 1; level < kBlurred; ++level) between_[level] = blur_to(level);
  }

  void search_octaves() {
    for (octave_ = 0;; ++octave_) {
      for (int level = 1; level < kBlurred; ++level)
        blur(plane(scratch_.blurred[level - 1]), between_[level], plane(scratch_.blurred[level]),
             plane(scratch_.difference[level - 1]));
      find_places();
      describe_places();
      if (octave_ + 1 == params_.octaves || std::min(size_.width, size_.height) / 2 < kSmallestOctave) return;
      halve();
    }
  }

 private:
  View<float> plane(Image<float>& image) const { return {image.row(0), size_, image.stride()}; }

  void blur(View<const float> src, const BlurKernel& kernel, View<float> dst, View<float> difference) {
    pool_.rows(size_.height, [&](int begin, int end) { kernels_.blur(src, kernel, dst, difference, begin, end); });
  }

  void halve() {
    const View<const float> src = plane(scratch_.blurred[kLevels]);
    size_ = {(size_.width + 1) / 2, (size_.height + 1) / 2};
    const View<float> dst = plane(scratch_.blurred[0]);
    pool_.rows(size_.height, [&](int begin, int end) {
      for (int y = begin; y < end; ++y)
        for (int x = 0; x < size_.width; ++x) dst.at(y, x) = src.at(2 * y, 2 * x);
    });
  }

  /// Extrema of this octave in the window, refined, in order, each once.
  void find_places() {
    count_ = 0;
    // A pixel more than the window on each side: its extremum may be refined to lie inside.
    const int x_begin = std::max(kBorder, ((window_.x - x0_) >> octave_) - 1);
    const int y_begin = std::max(kBorder, ((window_.y - y0_) >> octave_) - 1);
    const int x_end = std::min(size_.width - kBorder, ((window_.x - x0_ + window_.width - 1) >> octave_) + 2);
    const int y_end = std::min(size_.height - kBorder, ((window_.y - y0_ + window_.height - 1) >> octave_) + 2);
    if (x_begin >= x_end || y_begin >= y_end) return;
    for (int i = 0; i < kLevels + 2; ++i) differences_[i] = plane(scratch_.difference[i]);
    const float threshold = least_difference(params_);
    for (int level = 1; level <= kLevels; ++level) {
      const View<const float> three[3] = {differences_[level - 1], differences_[level], differences_[level + 1]};
      const Image<std::uint8_t>& marks = scratch_.marks[level - 1];
      const View<std::uint8_t> view = {scratch_.marks[level - 1].row(0), size_, marks.stride()};
      pool_.rows(y_end - y_begin, [&](int begin, int end) {
        kernels_.mark(three, threshold, view, x_begin, x_end, y_begin + begin, y_begin + end);
      });
    }
    for (int level = 1; level <= kLevels; ++level)
      for (int y = y_begin; y < y_end; ++y) {
        const std::uint8_t* row = scratch_.marks[level - 1].row(y);
        for (int x = x_begin; x < x_end; ++x) {
          const void* next = std::memchr(row + x, 1, static_cast<std::size_t>(x_end - x));
          if (next == nullptr) break;
          x = static_cast<int>(static_cast<const std::uint8_t*>(next) - row);
          add_place({level, y, x});
        }
      }
  }

  void add_place(const Pixel& extremum) {
    Pixel at = extremum;
    SiftScratch::Place place;
    if (!refine(differences_, params_, at, place) || !in_window(place)) return;
    place.scale = static_cast<float>(scale_of(place.scale));
    if (!(at == extremum)) {
      // Where it ended there may be an extremum of its own, or one that moved there before. 2: not to be visited.
      std::uint8_t& mark = scratch_.marks[at.level - 1].at(at.y, at.x);
      if (mark != 0) return;
      mark = 2;
    }
    if (count_ == out_.capacity())
      ++out_.overflow;
    else
      scratch_.places[static_cast<std::size_t>(count_++)] = place;
  }

  bool in_window(const SiftScratch::Place& place) const {
    const float step = static_cast<float>(1 << octave_), x = x0_ + place.x * step, y = y0_ + place.y * step;
    return x >= window_.x && y >= window_.y && x < window_.x + window_.width && y < window_.y + window_.height;
  }

  void describe_places() {
    if (count_ == 0) return;
    for (int level = 0; level < kLevels; ++level) {
      const View<const float> src = plane(scratch_.blurred[level + 1]);
      const View<float> magnitude = plane(scratch_.magnitude[level]), turns = plane(scratch_.turns[level]);
      pool_.rows(size_.height - 2, [&](int begin, int end) { kernels_.gradient(src, magnitude, turns, begin + 1, end + 1); });
      gradients_[level] = {magnitude, turns};
    }
    pool_.rows(count_, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) orient(scratch_.places[static_cast<std::size_t>(i)]);
    });
    const int first = out_.count;
    for (int i = 0; i < count_; ++i) add_points(scratch_.places[static_cast<std::size_t>(i)]);
    pool_.rows(out_.count - first, [&](int begin, int end) {
      for (int i = first + begin; i < first + end; ++i) describe(out_[i], out_.descriptors.row(i));
    });
  }

  void orient(SiftScratch::Place& place) {
    const SiftPoint p = {place.x, place.y, place.scale};
    std::int32_t histogram[kDirections] = {};
    kernels_.directions(gradients_[place.level - 1], around(p, size_, 4.5f * p.scale_px, 1.5 * p.scale_px), histogram);
    find_angles(histogram, place);
  }

  /// Still in pixels of the octave, angles in turns.
  void add_points(const SiftScratch::Place& place) {
    for (int i = 0; i < place.angles; ++i) {
      if (out_.count == out_.capacity())
        ++out_.overflow;
      else
        out_[out_.count++] = {place.x, place.y, place.scale, place.turns[i], place.response, octave_byte(), place.level};
    }
  }
  std::uint8_t octave_byte() const { return static_cast<std::uint8_t>(octave_); }

  void describe(SiftPoint& p, std::uint8_t* descriptor) {
    const float cell_px = 3 * p.scale_px;
    double cos, sin;
    cos_sin(p.angle_rad, cos, sin);
    const CellFrame frame = {static_cast<float>(cos / cell_px), static_cast<float>(sin / cell_px), p.angle_rad};
    constexpr float kDiagonal = 1.41421356f * (kCells + 1) / 2;  // cells from the centre to the last sample that counts
    std::int32_t histogram[kBins * kBins * kCellDirections] = {};
    kernels_.cells(gradients_[p.level - 1], around(p, size_, kDiagonal * cell_px, kCells / 2 * double{cell_px}), frame,
                   histogram);
    normalize(histogram, descriptor);

    const float step = static_cast<float>(1 << octave_);
    p.x_px = x0_ + p.x_px * step;
    p.y_px = y0_ + p.y_px * step;
    p.scale_px *= step;
    p.angle_rad *= 6.28318531f;
  }

  const Kernels& kernels_;
  Pool& pool_;
  const Window& window_;
  const SiftParams& params_;
  SiftScratch& scratch_;
  SiftPoints& out_;
  int x0_ = 0, y0_ = 0, octave_ = 0, count_ = 0;
  Size size_;  // of the current octave
  BlurKernel between_[kBlurred];
  View<const float> differences_[kLevels + 2];
  Gradient gradients_[kLevels];
};

}  // namespace

BlurKernel blur_of_picture() { return kernel_between(kCameraSigma, kSigma); }
BlurKernel blur_to(int level) { return kernel_between(scale_of(level - 1), scale_of(level)); }
float least_difference(const SiftParams& params) { return 0.5f * params.contrast / kLevels * 255; }

void run(const Kernels& kernels, Pool& pool, View<const std::uint8_t> src, const Window& window, const SiftParams& params,
         SiftScratch& scratch, SiftPoints& out) {
  DUO_CHECK(params.octaves >= 1 && params.octaves <= 8 && params.margin_px >= 0);
  DUO_CHECK(static_cast<int>(scratch.places.size()) >= out.capacity());
  out.count = out.overflow = 0;
  const Window inside = window.within(src.size());
  if (inside.empty()) return;
  Search search(kernels, pool, inside, params, scratch, out);
  search.start(src);
  search.search_octaves();
}

}  // namespace sift
}  // namespace duo
