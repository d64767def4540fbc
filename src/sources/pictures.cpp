#include "sources/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "core/file.h"
#include "duoptic/source.h"
#include "sources/file_source.h"
#include "sources/libav.h"
#include "sources/picture_bytes.h"

extern "C" {
#include <libavutil/imgutils.h>
}

namespace duo {
namespace {

using namespace std::string_view_literals;

struct Kind {
  std::string_view magic;
  AVCodecID codec;
};
constexpr Kind kKinds[] = {
    {"\x89PNG\r\n\x1a\n"sv, AV_CODEC_ID_PNG},
    {"\xff\xd8\xff"sv, AV_CODEC_ID_MJPEG},
    {"II*\0"sv, AV_CODEC_ID_TIFF},
    {"MM\0*"sv, AV_CODEC_ID_TIFF},
    {"BM"sv, AV_CODEC_ID_BMP},
    {"P2"sv, AV_CODEC_ID_PGM},
    {"P5"sv, AV_CODEC_ID_PGM},
    {"P3"sv, AV_CODEC_ID_PPM},
    {"P6"sv, AV_CODEC_ID_PPM},
};

AVCodecID picture_codec(std::string_view head) {
  for (const Kind& kind : kKinds)
    if (head.starts_with(kind.magic)) return kind.codec;
  if (head.size() >= 12 && head.starts_with("RIFF") && head.substr(8, 4) == "WEBP") return AV_CODEC_ID_WEBP;
  return AV_CODEC_ID_NONE;
}

// JPEG and PNG say where they end; a file cut after the last pixel but before that is still cut, and decoders forgive it.
bool has_its_end(AVCodecID codec, std::string_view bytes) {
  if (codec == AV_CODEC_ID_MJPEG) return bytes.rfind("\xff\xd9"sv) != std::string_view::npos;
  if (codec == AV_CODEC_ID_PNG) return bytes.rfind("IEND\xae\x42\x60\x82"sv) != std::string_view::npos;
  if (codec == AV_CODEC_ID_BMP && bytes.size() >= 6) {
    std::uint32_t announced = 0;
    for (int i = 3; i >= 0; --i) announced = announced << 8 | static_cast<std::uint8_t>(bytes[static_cast<std::size_t>(2 + i)]);
    return bytes.size() >= announced;
  }
  return true;
}

/// As libav's own, with `opaque`'s byte in all memory: what a decoder does not write can be told.
int get_filled_buffer(AVCodecContext* context, AVFrame* frame, int flags) {
  const int got = avcodec_default_get_buffer2(context, frame, flags);
  for (int i = 0; got >= 0 && i < AV_NUM_DATA_POINTERS && frame->buf[i] != nullptr; ++i)
    std::memset(frame->buf[i]->data, *static_cast<const std::uint8_t*>(context->opaque), frame->buf[i]->size);
  return got;
}

/// Rows of the first plane that have nothing but `fill`.
std::vector<int> rows_of(const AVFrame& frame, std::uint8_t fill) {
  std::vector<int> rows;
  const int bytes = av_image_get_linesize(static_cast<AVPixelFormat>(frame.format), frame.width, 0);
  for (int y = 0; y < frame.height; ++y) {
    const std::uint8_t* row = frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0];
    if (std::all_of(row, row + std::max(bytes, 0), [&](std::uint8_t value) { return value == fill; })) rows.push_back(y);
  }
  return rows;
}

/// Decodes a whole file as one packet, into memory of `fill`.
///
/// Errors  it is no picture, or any part of it is missing or damaged; of an unsupported kind; too many pixels
Result<av::DecodedFrame> decode(std::string_view bytes, const std::string& name, std::uint8_t fill) {
  const AVCodecID codec = picture_codec(bytes);
  const auto refused = [&](int error) {
    if (const std::string kind = unsupported_in(bytes); !kind.empty() || error == AVERROR_PATCHWELCOME)
      return Error{ErrorCode::kUnsupported, fmt::format("cannot read {}: {} not supported; save it as an 8-bit PNG", name,
                                                        kind.empty() ? "its kind of coding is" : kind + " is")};
    // What libav says of a size that it is not to decode.
    const std::string why =
        error == AVERROR(EINVAL) ? "it has " + av::too_many_pixels() : "it is cut short or damaged; copy or record it again";
    return av::input_error(name, error, why);
  };
  if (!unsupported_in(bytes).empty() || !has_its_end(codec, bytes)) return refused(AVERROR_INVALIDDATA);
  av::Packet packet(av_packet_alloc());
  av::DecodedFrame frame(av_frame_alloc());
  const av::Decoder decoder = av::open_decoder(codec, [&](AVCodecContext& context) {
    context.err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER;
    // libav's TIFF decoder refuses whole files when told to be strict, and cut ones always.
    if (context.codec_id != AV_CODEC_ID_TIFF) context.err_recognition |= AV_EF_EXPLODE;
    context.opaque = &fill;
    context.get_buffer2 = get_filled_buffer;
    return true;
  });
  if (!decoder || !packet || !frame || av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0)
    return refused(AVERROR(ENOMEM));
  bytes.copy(reinterpret_cast<char*>(packet->data), bytes.size());
  errno = 0;
  int outcome = avcodec_send_packet(decoder.get(), packet.get());
  if (outcome >= 0) avcodec_send_packet(decoder.get(), nullptr);
  if (outcome >= 0) outcome = avcodec_receive_frame(decoder.get(), frame.get());
  if (outcome == AVERROR_EXTERNAL && errno == ENOMEM) outcome = AVERROR(ENOMEM);  // zlib's memory, of which libav does not tell
  if (outcome < 0 || av::is_damaged(*frame)) return refused(outcome);
  if (const std::string why = av::too_many_pixels({frame->width, frame->height}); !why.empty())
    return av::input_error(name, 0, why);
  return frame;
}

/// A decoder that gives nothing, or not all rows, is found out: they hold what the memory held before, whatever that was.
Result<av::DecodedFrame> decode(std::string_view bytes, const std::string& name) {
  constexpr std::uint8_t kFill = 0x5a, kOtherFill = 0xa5;
  DUO_TRY_ASSIGN(av::DecodedFrame frame, decode(bytes, name, kFill));
  const std::vector<int> rows = rows_of(*frame, kFill);
  if (rows.empty()) return frame;
  DUO_TRY_ASSIGN(const av::DecodedFrame again, decode(bytes, name, kOtherFill));
  const std::vector<int> still = rows_of(*again, kOtherFill);
  if (std::none_of(rows.begin(), rows.end(), [&](int y) { return std::binary_search(still.begin(), still.end(), y); }))
    return frame;
  return Error{ErrorCode::kUnsupported,
               fmt::format("cannot read {}: parts of it cannot be decoded; save it as an 8-bit PNG", name)};
}

class PictureFile final : public FileSource {
 public:
  /// What `bytes`, a part of the file `name`, hold.
  Result<void> open(std::string_view bytes, const std::string& name) {
    DUO_TRY_ASSIGN(frame_, decode(bytes, name));
    orientation_ = orientation_of(bytes);
    coding_noise_q4_ = coding_noise_q4(bytes);
    if (const int held = pictures_held(bytes); held > 1)
      warning_ = fmt::format(
          "{} holds {} pictures one after the other: the first is used; save each as a file, or all as a video", name, held);
    size_ = upright({frame_->width, frame_->height}, orientation_);
    to_rgb_.see(*frame_);
    if (to_rgb_.convert(*frame_, pixels_)) return {};
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read {}: its size or kind of pixels is not supported; save it as an 8-bit PNG", name)};
  }
  void hold(std::optional<ViewLayout> layout, int views) { layout_ = layout, views_ = views; }

  Size size() const override { return size_; }
  std::int64_t count() const override { return 1; }
  bool still() const override { return true; }
  std::optional<ViewLayout> layout() const override { return layout_; }
  int views() const override { return views_; }
  std::string warning() const override { return warning_; }
  void scale_as(FileSource& other) override {
    if (auto* picture = dynamic_cast<PictureFile*>(&other); picture != nullptr) to_rgb_.scale_as(picture->to_rgb_);
  }
  Result<Next> next(Picture& into) override {
    if (std::exchange(given_, true)) return Next::kEnd;
    if (is_wide(frame_->format)) to_rgb_.convert(*frame_, pixels_);  // its scale may be another one by now
    Image<Rgb8> turned;
    put_upright(pixels_, orientation_, turned);
    into.pixels = std::move(pixels_);
    into.jpeg.clear();
    into.coding_noise_q4 = coding_noise_q4_;
    into.t_ns = 0;
    into.sequence = 0;
    return Next::kNew;
  }

 private:
  av::DecodedFrame frame_;
  av::ToRgb to_rgb_;
  Image<Rgb8> pixels_;
  int coding_noise_q4_ = 0;
  Orientation orientation_ = Orientation::kTopLeft;
  Size size_;
  std::optional<ViewLayout> layout_;
  int views_ = 1;
  std::string warning_;
  bool given_ = false;
};

}  // namespace

bool is_picture(std::string_view head) { return picture_codec(head) != AV_CODEC_ID_NONE; }

Result<std::unique_ptr<Source>> open_picture(const std::filesystem::path& path, int view) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;
  DUO_TRY_ASSIGN(const std::string bytes, read_file(path, kMaxBytes, "picture"));
  const std::vector<std::string_view> views = views_of_mpo(bytes);
  const bool several = views.size() > static_cast<std::size_t>(view);
  auto picture = std::make_unique<PictureFile>();
  DUO_TRY(picture->open(several ? views[static_cast<std::size_t>(view)] : std::string_view(bytes), "picture " + path.string()));
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  picture->hold(layout_of_jps(bytes, ending == ".jps"), several ? 2 : 1);
  return std::unique_ptr<Source>(std::move(picture));
}

Result<Image<std::uint16_t>> read_png16(const std::filesystem::path& path) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 28;
  DUO_TRY_ASSIGN(const std::string bytes, read_file(path, kMaxBytes, "PNG picture"));
  const auto refused = [&](const char* why) {
    return Error{ErrorCode::kBadInput, fmt::format("cannot read PNG picture '{}': {}", path.string(), why)};
  };
  if (picture_codec(bytes) != AV_CODEC_ID_PNG) return refused("it is no PNG picture");
  DUO_TRY_ASSIGN(const av::DecodedFrame frame, decode(bytes, fmt::format("PNG picture '{}'", path.string())));
  Image<std::uint16_t> out({frame->width, frame->height});
  for (int y = 0; y < out.height(); ++y) {
    const std::uint8_t* from = frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0];
    for (int x = 0; x < out.width(); ++x) {
      if (frame->format == AV_PIX_FMT_GRAY8)
        out.at(y, x) = from[x];
      else if (frame->format == AV_PIX_FMT_GRAY16BE)
        out.at(y, x) = static_cast<std::uint16_t>(from[2 * x] << 8 | from[2 * x + 1]);
      else if (frame->format == AV_PIX_FMT_MONOBLACK)
        out.at(y, x) = (from[x / 8] >> (7 - x % 8) & 1) != 0 ? 255 : 0;
      else
        return refused("it is coloured; give a gray one");
    }
  }
  return out;
}

}  // namespace duo
