#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "core/file.h"
#include "duoptic/sink.h"

namespace duo {
namespace {

constexpr int kMaxSide = 16384;
static_assert(std::endian::native == std::endian::little, "PFM files are written as the machine holds its floats");

Error pfm_error(const std::string& name, std::string_view why) {
  return {ErrorCode::kBadInput, fmt::format("cannot read PFM picture '{}': {}", name, why)};
}

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// Takes the next word of the header, and the one white space after it.
std::string_view take_word(std::string_view& rest) {
  constexpr std::size_t kLongest = 32;
  while (!rest.empty() && is_space(rest.front())) rest.remove_prefix(1);
  std::size_t length = 0;
  while (length < rest.size() && length < kLongest && !is_space(rest[length])) ++length;
  const std::string_view word = rest.substr(0, length);
  rest.remove_prefix(std::min(length + 1, rest.size()));
  return word;
}

template <class T>
bool to_number(std::string_view word, T& out) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  return error == std::errc{} && end == word.data() + word.size();
}

}  // namespace

Result<Image<float>> parse_pfm(std::string_view bytes, const std::string& name) {
  std::string_view rest = bytes;
  const std::string_view kind = take_word(rest);
  if (kind == "PF") return pfm_error(name, "it has three channels; give one of disparity");
  if (kind != "Pf") return pfm_error(name, "it does not begin with 'Pf'; give a PFM file");
  Size size;
  double scale = 0;
  const bool sized = to_number(take_word(rest), size.width) && to_number(take_word(rest), size.height);
  if (!sized || size.empty() || size.width > kMaxSide || size.height > kMaxSide)
    return pfm_error(name, fmt::format("its header gives no size from 1x1 to {}x{}; write the file again", kMaxSide, kMaxSide));
  if (!to_number(take_word(rest), scale) || !std::isfinite(scale) || scale == 0)
    return pfm_error(name, "its header gives no byte order (a number below or above 0); write the file again");
  const std::size_t row_bytes = static_cast<std::size_t>(size.width) * sizeof(float);
  const std::size_t needed = row_bytes * static_cast<std::size_t>(size.height);
  if (rest.size() < needed)
    return pfm_error(name, fmt::format("it is cut short: {}x{} pixels need {} bytes, it has {}; write the file again",
                                       size.width, size.height, needed, rest.size()));

  Image<float> picture(size);
  for (int y = 0; y < size.height; ++y) {
    float* row = picture.row(size.height - 1 - y);  // a PFM goes from bottom to top
    std::memcpy(row, rest.data() + static_cast<std::size_t>(y) * row_bytes, row_bytes);
    if (scale > 0)
      for (int x = 0; x < size.width; ++x)
        row[x] = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(row[x])));
  }
  return picture;
}

Result<Image<float>> read_pfm(const std::filesystem::path& path) {
  constexpr std::size_t kMaxBytes = std::size_t{kMaxSide} * kMaxSide * sizeof(float) + 256;
  DUO_TRY_ASSIGN(const std::string bytes, read_file(path, kMaxBytes, "PFM picture"));
  return parse_pfm(bytes, path.string());
}

Result<void> write_pfm(View<const std::uint16_t> d_q4, const std::filesystem::path& path) {
  std::string bytes = fmt::format("Pf\n{} {}\n-1.0\n", d_q4.width(), d_q4.height());
  std::vector<float> row(static_cast<std::size_t>(d_q4.width()));
  for (int y = d_q4.height() - 1; y >= 0; --y) {
    for (int x = 0; x < d_q4.width(); ++x) {
      const std::uint16_t d = d_q4.at(y, x);
      row[static_cast<std::size_t>(x)] =
          d == Disparity::kNone ? std::numeric_limits<float>::infinity() : static_cast<float>(d) / 16;
    }
    bytes.append(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(float));
  }
  return write_file(path, bytes);
}

}  // namespace duo
