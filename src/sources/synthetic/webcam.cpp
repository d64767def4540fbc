#include "sources/synthetic/webcam.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

// 8-bit code of linear light. Above kKnee the curve bends over, as webcams' do, so that windows do not clip at once.
class Curve {
 public:
  Curve() : code_(kSteps + 1) {
    for (int i = 0; i <= kSteps; ++i) code_[i] = 255 * encode(shoulder(kTop * i / kSteps)) + 0.5;
  }
  std::uint8_t operator()(double light) const {
    const double at = std::clamp(light / kTop, 0.0, 1.0) * kSteps;
    const int i = std::min(static_cast<int>(at), kSteps - 1);
    return static_cast<std::uint8_t>(std::min(code_[i] + (code_[i + 1] - code_[i]) * (at - i), 255.0));
  }

 private:
  static constexpr int kSteps = 8192;
  static constexpr double kTop = 4, kKnee = 0.6;

  static double shoulder(double v) {
    if (v < kKnee) return v;
    const double over = (v - kKnee) / (1 - kKnee);
    return kKnee + (1 - kKnee) * over / (1 + over);
  }
  // The sRGB curve; v^(1/2.4) = w sqrt(sqrt(w)) with w the cube root, by Newton's method: no pow(), whose last bit differs.
  static double encode(double v) {
    if (v <= 0.0031308) return 12.92 * v;
    double w = 1;
    for (int i = 0; i < 40; ++i) w -= (w - v / (w * w)) / 3;
    return 1.055 * w * std::sqrt(std::sqrt(w)) - 0.055;
  }

  std::vector<double> code_;
};

// Close to a normal distribution of sigma 1: the sum of four evenly distributed 16-bit numbers.
double bell(std::uint32_t a, std::uint32_t b) {
  constexpr double kUnit = 1.7320508075688772 / 65536;
  return kUnit * (static_cast<double>((a & 0xFFFF) + (a >> 16) + (b & 0xFFFF) + (b >> 16)) - 131070.0);
}

Color blurred(const Image<Color>& raw, double weight, int y, int x) {
  const auto row = [&](int yy) {
    const Color* line = raw.row(std::clamp(yy, 0, raw.height() - 1));
    return weight * (line[std::max(x - 1, 0)] + line[std::min(x + 1, raw.width() - 1)]) + (1 - 2 * weight) * line[x];
  };
  return weight * (row(y - 1) + row(y + 1)) + (1 - 2 * weight) * row(y);
}

}  // namespace

Image<Rgb8> develop(Pool& pool, const Image<Color>& raw, const Webcam& webcam) {
  static const Curve curve;
  Image<Rgb8> picture(raw.size());
  const int w = raw.width(), h = raw.height();
  const double cx = (w - 1) / 2.0, cy = (h - 1) / 2.0, corner2 = std::max(cx * cx + cy * cy, 1.0);
  pool.rows(h, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < w; ++x) {
        const double rr = ((x - cx) * (x - cx) + (y - cy) * (y - cy)) / corner2;
        const Color c =
            (1 - webcam.vignetting * rr) * webcam.gain * (webcam.blur > 0 ? blurred(raw, webcam.blur, y, x) : raw.at(y, x));
        const auto sensed = [&](double v, int channel) {
          if (webcam.shot_noise > 0 || webcam.read_noise > 0) {
            const std::uint32_t a = hash(webcam.seed, x, y, channel);
            const double sigma = std::sqrt(webcam.shot_noise * webcam.shot_noise * v + webcam.read_noise * webcam.read_noise);
            v += sigma * bell(a, mix(a + 1));
          }
          return curve(v);
        };
        picture.at(y, x) = {sensed(c.r, 0), sensed(c.g, 1), sensed(c.b, 2)};
      }
  });
  return picture;
}

}  // namespace duo::synthetic
