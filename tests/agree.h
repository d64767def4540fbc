// The one harness in which engines are held against the reference, in the manner of dav1d's checkasm: random and extreme
// inputs, sizes around the vector width, odd strides, every instruction set this machine has, one and two threads.
// A difference is reported at its first pixel with engine, size, position, wanted and got value.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/pool.h"
#include "duoptic/frame.h"
#include "duoptic/image.h"

namespace duo::test {

inline constexpr int kNone = Disparity::kNone;

template <class T>
Image<T> image(std::initializer_list<std::initializer_list<int>> rows) {
  Image<T> out({static_cast<int>(rows.begin()->size()), static_cast<int>(rows.size())});
  int y = 0;
  for (const auto& row : rows) {
    int x = 0;
    for (int v : row) out.at(y, x++) = static_cast<T>(v);
    ++y;
  }
  return out;
}

template <class T>
Image<T> constant(Size size, int value) {
  Image<T> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) out.at(y, x) = static_cast<T>(value);
  return out;
}

enum class Fill { kRandom, kLow, kHigh, kCheckerboard, kConstant };
inline constexpr Fill kFills[] = {Fill::kRandom, Fill::kLow, Fill::kHigh, Fill::kCheckerboard, Fill::kConstant};

template <class T>
void fill(View<T> out, Fill how, std::mt19937& rng) {
  constexpr int kMax = std::numeric_limits<T>::max();
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int r = static_cast<int>(rng());
      switch (how) {
        case Fill::kRandom:
          out.at(y, x) = static_cast<T>(r);
          break;
        case Fill::kLow:
          out.at(y, x) = static_cast<T>(r & 1);
          break;
        case Fill::kHigh:
          out.at(y, x) = static_cast<T>(kMax - (r & 1));
          break;
        case Fill::kCheckerboard:
          out.at(y, x) = static_cast<T>((x + y) % 2 ? kMax : 0);
          break;
        case Fill::kConstant:
          out.at(y, x) = static_cast<T>(kMax / 3);
          break;
      }
    }
}

/// Sizes that break vector code: one pixel, narrower than a window, vector widths -1, +0, +1, and an ordinary one.
inline std::vector<Size> awkward_sizes() {
  return {{1, 1},  {2, 3},  {3, 2},  {5, 9},   {15, 4}, {16, 7},   {17, 5},  {31, 8},
          {33, 6}, {63, 9}, {64, 3}, {65, 11}, {67, 1}, {129, 10}, {131, 37}};
}

/// Pixels with an odd stride and no padding: the least a View promises.
template <class T>
struct Tight {
  std::vector<T> pixels;
  View<T> view;
  explicit Tight(Size size) : pixels(static_cast<std::size_t>(size.width + 3) * size.height) {
    view = View<T>(pixels.data() + 1, size, size.width + 3);
    // The last row ends two elements before the end, so a read or write past it is caught by the address sanitizer.
  }
};

/// Calls f(name) once for each instruction set that is compiled in and that this machine can run.
template <class F>
void each_target(F&& f) {
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    if ((target & HWY_TARGETS) == 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    f(std::string(hwy::TargetName(target)));
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// Fails at the first pixel where `got` differs from `want`; returns whether they agree.
template <class T>
bool expect_same(View<const T> want, View<const T> got, const std::string& what) {
  if (!(want.size() == got.size())) {
    ADD_FAILURE() << what << ": sizes differ";
    return false;
  }
  for (int y = 0; y < want.height(); ++y)
    for (int x = 0; x < want.width(); ++x)
      if (!(want.at(y, x) == got.at(y, x))) {
        ADD_FAILURE() << what << " " << want.width() << "x" << want.height() << " y=" << y << " x=" << x << ": want "
                      << +want.at(y, x) << " got " << +got.at(y, x);
        return false;
      }
  return true;
}

/// Holds a stage with one input and one output of the same size against its reference.
template <class In, class Out, class Ref, class Simd>
void agree(const std::string& stage, Ref ref, Simd simd) {
  std::mt19937 rng(1);
  Pool one(1), two(2);
  for (const Size size : awkward_sizes())
    for (const Fill how : kFills) {
      Tight<In> src(size);
      Tight<Out> want(size);
      fill(src.view, how, rng);
      ref(View<const In>(src.view), want.view);
      each_target([&](const std::string& target) {
        for (Pool* pool : {&one, &two}) {
          Tight<Out> got(size);
          simd(*pool, View<const In>(src.view), got.view);
          expect_same<Out>(want.view, got.view, stage + " simd " + target + " threads " + std::to_string(pool->threads()));
        }
      });
      if (::testing::Test::HasFailure()) return;
    }
}

}  // namespace duo::test
