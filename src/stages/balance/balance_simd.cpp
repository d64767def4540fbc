#include <algorithm>
#include <mutex>

#include "core/check.h"
#include "stages/balance/balance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/balance/balance_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The sums of a row's whole vectors; returns how many pixels these are. `mask` may be null.
int sum_row(const std::uint8_t* row, const std::uint8_t* mask, int w, BrightnessSums& sums) {
  const hn::ScalableTag<std::uint8_t> d8;
  const hn::RepartitionToWide<decltype(d8)> d16;
  const hn::RepartitionToWide<decltype(d16)> d32;
  const hn::RepartitionToWide<decltype(d32)> d64;
  const int n = static_cast<int>(hn::Lanes(d8));
  const auto low = hn::Set(d16, 0xFF);
  const auto low_half = hn::Set(d32, 0xFFFF);
  auto count = hn::Zero(d64), sum = hn::Zero(d64);
  auto squares = hn::Zero(d32);  // of four pixels a vector: 32 bits are enough for rows of 260,000 pixels
  int x = 0;
  for (; x + n <= w; x += n) {
    auto v = hn::LoadU(d8, row + x);
    auto counts = hn::Set(d8, 1);
    if (mask != nullptr) {
      const auto inside = hn::Ne(hn::LoadU(d8, mask + x), hn::Zero(d8));
      v = hn::IfThenElseZero(inside, v);
      counts = hn::IfThenElseZero(inside, counts);
    }
    count = hn::Add(count, hn::SumsOf8(counts));
    sum = hn::Add(sum, hn::SumsOf8(v));
    const auto even = hn::And(hn::BitCast(d16, v), low), odd = hn::ShiftRight<8>(hn::BitCast(d16, v));
    const auto add_squares = [&](auto halves) HWY_ATTR {
      const auto squared = hn::BitCast(d32, hn::Mul(halves, halves));
      squares = hn::Add(squares, hn::Add(hn::And(squared, low_half), hn::ShiftRight<16>(squared)));
    };
    add_squares(even);
    add_squares(odd);
  }
  const auto halves = hn::BitCast(d64, squares);
  const auto squares64 = hn::Add(hn::And(halves, hn::Set(d64, 0xFFFFFFFF)), hn::ShiftRight<32>(halves));
  const auto total = [&](auto v) HWY_ATTR { return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(d64, v))); };
  sums.add({total(count), total(sum), total(squares64)});
  return x;
}

/// The whole vectors of a row looked up in 256 values; returns how many pixels these are. Sixteen tables of sixteen: each gives
/// 0 for a value that is not its own.
int look_up_row(const std::uint8_t* src, const std::uint8_t* table, int w, std::uint8_t* dst) {
  const hn::ScalableTag<std::uint8_t> d;
  const int n = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + n <= w; x += n) {
    const auto v = hn::LoadU(d, src + x);
    auto found = hn::Zero(d);
    for (int part = 0; part < 16; ++part) {
      // 0 .. 15 become 0x70 .. 0x7F, all else 0x80 and more: the high bit asks for 0, the low ones are the index.
      const auto raised = hn::SaturatedAdd(hn::Sub(v, hn::Set(d, static_cast<std::uint8_t>(16 * part))), hn::Set(d, 0x70));
      const auto index = hn::And(raised, hn::Set(d, 0x8F));
      found = hn::Or(found, hn::TableLookupBytesOr0(hn::LoadDup128(d, table + 16 * part), index));
    }
    hn::StoreU(found, d, dst + x);
  }
  return x;
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sum_row);
HWY_EXPORT(look_up_row);

namespace simd {
namespace {

BrightnessSums sum_rows(View<const std::uint8_t> picture, View<const std::uint8_t> inside, int begin, int end) {
  BrightnessSums out;
  const int w = picture.width();
  int done = 0;
  for (int y = begin; y < end; ++y)
    done = HWY_DYNAMIC_DISPATCH(sum_row)(picture.row(y), inside.empty() ? nullptr : inside.row(y), w, out);
  const Size rest{w - done, picture.height()};
  if (rest.width > 0)
    out.add(brightness_sums(picture.crop(0, done, rest),
                            inside.empty() ? View<const std::uint8_t>{} : inside.crop(0, done, rest), begin, end));
  return out;
}

}  // namespace

// The order in which parts are added does not change integer sums.
void balance(Pool& pool, const GrayPair& pair, View<std::uint8_t> dst) {
  DUO_CHECK(pair.right.size() == dst.size());
  BrightnessSums left, right;
  std::mutex mutex;
  pool.rows(dst.height(), [&](int begin, int end) {
    const BrightnessSums l = sum_rows(pair.left, pair.left_inside, begin, end);
    const BrightnessSums r = sum_rows(pair.right, pair.right_inside, begin, end);
    const std::lock_guard lock(mutex);
    left.add(l);
    right.add(r);
  });
  alignas(16) const auto table = balance_table(left, right);
  pool.rows(dst.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const std::uint8_t* src = pair.right.row(y);
      int x = HWY_DYNAMIC_DISPATCH(look_up_row)(src, table.data(), dst.width(), dst.row(y));
      for (; x < dst.width(); ++x) dst.row(y)[x] = table[src[x]];
    }
  });
}

}  // namespace simd
}  // namespace duo
#endif
