#include "sources/picture_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>

namespace duo {

bool is_jpeg(std::string_view bytes) { return bytes.starts_with(std::string_view("\xff\xd8\xff", 3)); }

namespace {

using namespace std::string_view_literals;
constexpr std::size_t kNowhere = std::string_view::npos;

std::uint8_t byte_of(std::string_view bytes, std::size_t at) {
  return at < bytes.size() ? static_cast<std::uint8_t>(bytes[at]) : std::uint8_t{0};
}

std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t size, bool little) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | byte_of(bytes, at + (little ? size - 1 - i : i));
  return value;
}

/// A directory, at first the first one, of a TIFF, EXIF and MPO block: each is one.
class TiffTags {
 public:
  explicit TiffTags(std::string_view block) : block_(block), little_(block.starts_with("II")) {
    if (little_ || block.starts_with("MM")) enter(number(4, 4));
  }
  std::size_t directory() const { return directory_; }
  /// The next directory; false where there is none, as of a block that is not whole.
  bool next() {
    const std::size_t at = directory_ + 2 + 12 * entries_;
    if (directory_ == 0 || at + 4 > block_.size()) return false;
    enter(number(at, 4));
    return directory_ != 0 && directory_ + 2 < block_.size();
  }
  /// The first value of a tag of whole numbers, or an offset to its values.
  std::optional<std::uint32_t> of(std::uint32_t tag) const {
    for (std::size_t i = 0; i < entries_; ++i) {
      const std::size_t at = directory_ + 2 + 12 * i;
      if (at + 12 > block_.size()) break;
      if (number(at, 2) != tag) continue;
      constexpr std::uint32_t kShort = 3;
      if (number(at + 2, 2) != kShort) return number(at + 8, 4);
      const bool inside = number(at + 4, 4) <= 2;  // two fit in place of an offset
      return inside ? number(at + 8, 2) : number(number(at + 8, 4), 2);
    }
    return std::nullopt;
  }
  std::uint32_t number(std::size_t at, std::size_t size) const { return number_at(block_, at, size, little_); }

 private:
  void enter(std::size_t directory) {
    directory_ = directory;
    entries_ = std::min<std::size_t>(number(directory_, 2), 4096);
  }

  std::string_view block_;
  bool little_;
  std::size_t directory_ = 0, entries_ = 0;
};

constexpr std::uint8_t kApp1 = 0xe1, kApp2 = 0xe2, kApp3 = 0xe3, kScan = 0xda, kJpegEnd = 0xd9;

/// Calls `see(marker, content)` for each segment of a JPEG until that returns true. Returns the length up to the end mark, or
/// kNowhere.
std::size_t walk_jpeg(std::string_view bytes, const std::function<bool(std::uint8_t, std::string_view)>& see) {
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    if (byte_of(bytes, at) != 0xff) {  // coded pixels, up to a mark that does not belong to them
      at = bytes.find('\xff', at);
      if (at == kNowhere) return kNowhere;
    }
    const std::uint8_t marker = byte_of(bytes, at + 1);
    if (marker == 0xff) {
      ++at;
      continue;
    }
    if (marker == kJpegEnd) return at + 2;
    const bool alone = marker == 0 || marker == 1 || (marker >= 0xd0 && marker <= 0xd8);
    if (alone) {
      at += 2;
      continue;
    }
    const std::size_t size = number_at(bytes, at + 2, 2, false);
    if (size < 2 || at + 2 + size > bytes.size()) return kNowhere;
    if (see(marker, bytes.substr(at + 4, size - 2))) return kNowhere;
    at += 2 + size;
  }
  return kNowhere;
}

std::string_view jpeg_segment(std::string_view bytes, std::uint8_t marker, std::string_view name) {
  std::string_view found;
  walk_jpeg(bytes, [&](std::uint8_t m, std::string_view content) {
    if (m == marker && content.starts_with(name)) found = content.substr(name.size());
    return m == kScan || !found.empty();
  });
  return found;
}

/// The EXIF block of a PNG or WebP: both are chunks with a name and a length.
std::string_view exif_chunk(std::string_view bytes) {
  const bool png = bytes.starts_with("\x89PNG"sv);
  const std::string_view name = png ? "eXIf"sv : "EXIF"sv;
  for (std::size_t at = png ? 8 : 12; at + 8 <= bytes.size();) {
    const std::size_t size = number_at(bytes, png ? at : at + 4, 4, !png);
    const std::string_view content = bytes.substr(at + 8, size);
    if (bytes.substr(png ? at + 4 : at, 4) == name) return content.starts_with("Exif\0\0"sv) ? content.substr(6) : content;
    at += 8 + size + (png ? 4 : size % 2);
  }
  return {};
}

/// Of a segment that says size, bits and components.
bool is_frame_marker(std::uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

std::string unsupported_jpeg(std::string_view bytes) {
  std::string why;
  walk_jpeg(bytes, [&](std::uint8_t marker, std::string_view content) {
    if (!is_frame_marker(marker)) return marker == kScan;
    if (marker >= 0xc9) why = "arithmetic coding";
    if (marker == 0xc3 || (marker >= 0xc5 && marker <= 0xc7)) why = "lossless or hierarchical coding";
    if (byte_of(content, 0) != 8) why = fmt::format("{} bits a value", byte_of(content, 0));
    return true;
  });
  return why;
}

std::string unsupported_tiff(std::string_view bytes) {
  const TiffTags tags(bytes);
  switch (const std::uint32_t compression = tags.of(259).value_or(1)) {
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
    case 8:
    case 32773:
    case 32946:
      break;
    case 6:
    case 7:
      return "JPEG inside a TIFF";
    case 34712:
      return "JPEG 2000 inside a TIFF";
    case 34925:
      return "LZMA compression";
    case 50000:
      return "Zstandard compression";
    case 50001:
      return "WebP inside a TIFF";
    default:
      return fmt::format("compression {}", compression);
  }
  const std::uint32_t format = tags.of(339).value_or(1), bits = tags.of(258).value_or(1);
  if (format == 3) return fmt::format("floating-point values of {} bits", bits);
  if (format == 5 || format == 6) return "complex values";
  if (bits > 16) return fmt::format("values of {} bits", bits);
  return {};
}

}  // namespace

std::size_t jpeg_length(std::string_view bytes) {
  return is_jpeg(bytes) ? walk_jpeg(bytes, [](std::uint8_t, std::string_view) { return false; }) : kNowhere;
}

bool is_jpeg_sequence(std::string_view bytes) {
  const std::size_t length = jpeg_length(bytes);
  if (length == kNowhere) return false;
  const std::size_t next = bytes.find_first_not_of("\0\xff"sv, length);  // cameras fill up; 0xff is a JPEG's first byte, too
  if (next == kNowhere || next == 0 || !bytes.substr(next - 1).starts_with("\xff\xd8\xff"sv)) return false;
  return jpeg_segment(bytes, kApp2, "MPF\0"sv).empty();
}

std::vector<std::string_view> views_of_mpo(std::string_view bytes) {
  const std::string_view block = jpeg_segment(bytes, kApp2, "MPF\0"sv);
  if (block.empty() || bytes.find("hdrgm"sv) != kNowhere) return {};  // Ultra HDR: the second picture is a gain map
  const TiffTags tags(block);
  constexpr std::uint32_t kCount = 0xb001, kEntries = 0xb002, kPreview = 0x010000, kPanorama = 0x020001, kKinds = 0xffffff;
  const std::uint32_t count = tags.of(kCount).value_or(0);
  const std::size_t entries = tags.of(kEntries).value_or(0);
  const auto start = static_cast<std::size_t>(block.data() - bytes.data());
  std::vector<std::string_view> out;
  for (std::uint32_t i = 0; i < std::min(count, 16u); ++i) {
    const std::size_t at = entries + std::size_t{16} * i;
    const std::uint32_t kind = tags.number(at, 4) & kKinds, size = tags.number(at + 4, 4), offset = tags.number(at + 8, 4);
    if ((kind & 0xff0000) == kPreview || kind == kPanorama) continue;
    const std::size_t begin = i == 0 ? 0 : start + offset;  // counted from the block; of the first one it is 0
    if (begin >= bytes.size() || !is_jpeg(bytes.substr(begin))) continue;
    out.push_back(bytes.substr(begin, size));
  }
  if (out.size() < 2) return {};
  out.resize(2);
  return out;
}

namespace {

int pages_of_tiff(std::string_view bytes) {
  constexpr std::uint32_t kKind = 254, kSmallerCopy = 1, kMask = 4;
  constexpr std::size_t kMost = 10000;
  TiffTags tags(bytes);
  std::set<std::size_t> seen;  // directories, which could lead to each other in a circle
  int pages = 0;
  for (bool more = true; more && seen.size() < kMost && seen.insert(tags.directory()).second; more = tags.next())
    pages += (tags.of(kKind).value_or(0) & (kSmallerCopy | kMask)) == 0;
  return std::max(1, pages);
}

/// acTL, which says it, stands before the first pixels.
int pictures_of_png(std::string_view bytes) {
  const std::size_t pixels = bytes.find("IDAT"sv), said = bytes.substr(0, pixels).find("acTL"sv);
  return said == kNowhere ? 1 : static_cast<int>(std::clamp(number_at(bytes, said + 4, 4, false), 1u, 1u << 20));
}

/// Length of the binary PNM that `bytes` begin with; npos where its head is none.
std::size_t pnm_length(std::string_view bytes) {
  std::size_t at = 2, numbers[3] = {};  // width, height, largest value
  for (std::size_t& number : numbers) {
    while (at < bytes.size() && (std::isspace(byte_of(bytes, at)) != 0 || bytes[at] == '#'))
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    for (; at < bytes.size() && std::isdigit(byte_of(bytes, at)) != 0 && number < 1'000'000; ++at)
      number = 10 * number + (byte_of(bytes, at) - std::size_t{'0'});
    if (number == 0) return kNowhere;
  }
  return at + 1 + numbers[0] * numbers[1] * (bytes.starts_with("P6"sv) ? 3 : 1) * (numbers[2] > 255 ? 2 : 1);
}

int pictures_of_pnm(std::string_view bytes) {
  int count = 0;
  for (; bytes.starts_with("P5"sv) || bytes.starts_with("P6"sv); ++count) {
    const std::size_t length = pnm_length(bytes);
    if (length == kNowhere || length > bytes.size()) break;
    bytes.remove_prefix(length);
  }
  return std::max(1, count);
}

}  // namespace

int pictures_held(std::string_view bytes) {
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return pages_of_tiff(bytes);
  if (bytes.starts_with("\x89PNG"sv)) return pictures_of_png(bytes);
  return pictures_of_pnm(bytes);
}

Orientation orientation_of(std::string_view bytes) {
  std::string_view block = bytes;
  if (is_jpeg(bytes))
    block = jpeg_segment(bytes, kApp1, "Exif\0\0"sv);
  else if (bytes.starts_with("\x89PNG"sv) || bytes.starts_with("RIFF"))
    block = exif_chunk(bytes);
  constexpr std::uint32_t kOrientation = 274;
  return orientation_of_exif(TiffTags(block).of(kOrientation).value_or(1));
}

std::optional<ViewLayout> layout_of_jps(std::string_view bytes, bool named_jps) {
  // "_JPSJPS_", the length of what follows, then a descriptor: its bytes are, from the highest, separation, flags, layout,
  // kind.
  const std::string_view block = is_jpeg(bytes) ? jpeg_segment(bytes, kApp3, "_JPSJPS_"sv) : std::string_view();
  constexpr std::uint8_t kStereo = 1, kBeside = 2, kAbove = 3, kLeftFirst = 4;
  if (block.size() >= 6 && byte_of(block, 5) == kStereo) {
    const bool left_first = (byte_of(block, 3) & kLeftFirst) != 0;
    if (byte_of(block, 4) == kBeside) return left_first ? ViewLayout::kSideBySide : ViewLayout::kRightLeft;
    if (byte_of(block, 4) == kAbove) return left_first ? ViewLayout::kTopBottom : ViewLayout::kBottomTop;
  }
  return named_jps ? std::optional(ViewLayout::kRightLeft) : std::nullopt;
}

int coding_noise_q4(std::string_view bytes) {
  constexpr std::uint8_t kTables = 0xdb;
  constexpr std::size_t kLowest = 10;
  std::size_t squares[16] = {};  // per table
  std::uint8_t of_brightness = 0;
  if (!is_jpeg(bytes)) return 0;
  walk_jpeg(bytes, [&](std::uint8_t marker, std::string_view content) {
    // Bits a value, height, width, count; then of each component its name, sampling and table. Brightness comes first.
    if (is_frame_marker(marker)) of_brightness = byte_of(content, 8) & 15;
    while (marker == kTables && !content.empty()) {
      const std::size_t each = byte_of(content, 0) >> 4 != 0 ? 2 : 1, length = 1 + 64 * each;
      if (content.size() < length) return true;
      std::size_t& sum = squares[byte_of(content, 0) & 15];
      sum = 0;
      for (std::size_t i = 0; i < kLowest; ++i) {
        const std::size_t step = number_at(content, 1 + each * i, each, false);
        sum += step * step;
      }
      content.remove_prefix(length);
    }
    return marker == kScan;
  });
  return static_cast<int>(std::lround(16 * std::sqrt(static_cast<double>(squares[of_brightness]) / (12 * 64))));
}

void put_jpeg(std::string_view bytes, Picture& into) {
  into.jpeg.assign(bytes.begin(), bytes.end());
  into.coding_noise_q4 = coding_noise_q4(bytes);
}

std::string unsupported_in(std::string_view bytes) {
  if (is_jpeg(bytes)) return unsupported_jpeg(bytes);
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return unsupported_tiff(bytes);
  return {};
}

std::optional<ForeignKind> foreign_kind(std::string_view head) {
  constexpr std::string_view kPicture = "save it as PNG or JPEG",
                             kVideo = "make a Matroska of it: ffmpeg -i FILE -c copy FILE.mkv",
                             kBare = "give it times: ffmpeg -r 30 -i FILE -c copy FILE.mkv, with its camera's rate";
  struct Kind {
    std::size_t at;
    std::string_view magic;
    ForeignKind kind;
  };
  constexpr Kind kKinds[] = {
      {4, "ftyphei"sv, {"a HEIC file", kPicture}},
      {4, "ftyphev"sv, {"a HEIC file", kPicture}},
      {4, "ftypmif1"sv, {"a HEIF file", kPicture}},
      {4, "ftypmsf1"sv, {"a HEIF file", kPicture}},
      {4, "ftypavi"sv, {"an AVIF file", kPicture}},
      {0, "\xff\x0a"sv, {"a JPEG XL file", kPicture}},
      {4, "JXL \r\n"sv, {"a JPEG XL file", kPicture}},
      {4, "jP  \r\n"sv, {"a JPEG 2000 file", kPicture}},
      {0, "\xff\x4f\xff\x51"sv, {"a JPEG 2000 file", kPicture}},
      {0, "GIF8"sv, {"a GIF file", kPicture}},
      {0, "\x76\x2f\x31\x01"sv, {"an OpenEXR file", kPicture}},
      {0, "#?RADIANCE"sv, {"a Radiance HDR file", kPicture}},
      {0, "8BPS"sv, {"a Photoshop file", kPicture}},
      {0, "II+\0"sv, {"a BigTIFF file", kPicture}},
      {0, "MM\0+"sv, {"a BigTIFF file", kPicture}},
      {0, "\x49\x49\xbc\x01"sv, {"a JPEG XR file", kPicture}},
      {0, "PF\n"sv, {"a PFM file", kPicture}},
      {0, "Pf\n"sv, {"a PFM file", kPicture}},
      {0, "%PDF"sv, {"a PDF file", kPicture}},
      {0, "II\x55\0"sv, {"a camera raw file", kPicture}},
      {0, "FUJIFILMCCD-RAW"sv, {"a camera raw file", kPicture}},
      {0, "\x93NUMPY"sv, {"a NumPy file", kPicture}},
      {0, "YUV4MPEG2 "sv, {"a YUV4MPEG file", kVideo}},
      {0, "nut/multimedia container"sv, {"a NUT file", kVideo}},
      {0, "\x06\x0e\x2b\x34"sv, {"an MXF file", kVideo}},
      {0, "FLV\x01"sv, {"a Flash video", kVideo}},
      {0, "OggS"sv, {"an Ogg file", kVideo}},
      {0, "\x30\x26\xb2\x75"sv, {"a Windows Media file", kVideo}},
      {0, "\0\0\0\x01\x67"sv, {"bare H.264, which holds no times", kBare}},
      {0, "\0\0\x01\x67"sv, {"bare H.264, which holds no times", kBare}},
      {0, "\0\0\0\x01\x27"sv, {"bare H.264, which holds no times", kBare}},
      {0, "\0\0\0\x01\x09"sv, {"bare H.264, which holds no times", kBare}},
      {0, "\0\0\0\x01\x40\x01"sv, {"bare H.265, which holds no times", kBare}},
      {0, "\0\0\x01\x40\x01"sv, {"bare H.265, which holds no times", kBare}},
  };
  for (const Kind& kind : kKinds)
    if (head.size() > kind.at && head.substr(kind.at).starts_with(kind.magic)) return kind.kind;
  constexpr std::size_t kWebpFlags = 20, kAnimation = 2;
  if (head.size() > kWebpFlags && head.starts_with("RIFF") && head.substr(8, 8) == "WEBPVP8X" &&
      (static_cast<std::uint8_t>(head[kWebpFlags]) & kAnimation) != 0)
    return ForeignKind{"a moving WebP", kPicture};
  return {};
}

}  // namespace duo
