#include "duoptic/evaluation.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace duo {
namespace {

constexpr Perturbation kPerturbations[] = {
    {.name = "gain 0.8, +10", .gain = true},
    {.name = "noise sigma 4", .noise = true},
    {.name = "rows 0.5 px", .rows = true},
    {.name = "all three", .gain = true, .noise = true, .rows = true},
};

std::uint8_t pixel(double v) { return static_cast<std::uint8_t>(std::clamp(std::lround(v), 0L, 255L)); }

template <class F>
void each_value(Image<Rgb8>& picture, F f) {
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      Rgb8& p = picture.at(y, x);
      for (std::uint8_t* v : {&p.r, &p.g, &p.b}) *v = f(*v);
    }
}

void add_noise(Image<Rgb8>& picture, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> noise(0, 4);
  each_value(picture, [&](std::uint8_t v) { return pixel(v + noise(rng)); });
}

void shift_half_a_row(Image<Rgb8>& picture) {
  for (int y = 0; y + 1 < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      Rgb8& p = picture.at(y, x);
      const Rgb8& q = picture.at(y + 1, x);
      const auto mean = [](int a, int b) { return static_cast<std::uint8_t>((a + b + 1) / 2); };
      p = {mean(p.r, q.r), mean(p.g, q.g), mean(p.b, q.b)};
    }
}

}  // namespace

std::span<const Perturbation> perturbations() { return kPerturbations; }

Pair perturb(const Pair& pair, const Perturbation& how) {
  Pair out;
  out.sequence = pair.sequence;
  for (auto [from, to] : {std::pair{&pair.left, &out.left}, std::pair{&pair.right, &out.right}}) {
    to->pixels = from->pixels.clone();
    to->t_ns = from->t_ns;
    to->sequence = from->sequence;
  }
  if (how.rows) shift_half_a_row(out.right.pixels);
  if (how.gain) each_value(out.right.pixels, [](std::uint8_t v) { return pixel(0.8 * v + 10); });
  if (how.noise) {
    add_noise(out.left.pixels, 1);
    add_noise(out.right.pixels, 2);
  }
  return out;
}

}  // namespace duo
