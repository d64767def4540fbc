#include "sources/pictures.h"

#include <fmt/format.h>

#include <cerrno>
#include <string>

#include "core/file.h"
#include "duoptic/source.h"
#include "sources/libav.h"

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

/// Decodes a whole file as one packet.
///
/// Errors  it is no picture, or any part of it is missing or damaged; too many pixels
Result<av::DecodedFrame> decode(const std::string& bytes, const std::string& name) {
  const AVCodecID codec = picture_codec(bytes);
  const auto refused = [&](int error) {
    // What libav says of a size that it is not to decode.
    const std::string why =
        error == AVERROR(EINVAL) ? "it has " + av::too_many_pixels() : "it is cut short or damaged; copy or record it again";
    return av::input_error(name, error, why);
  };
  if (!has_its_end(codec, bytes)) return refused(AVERROR_INVALIDDATA);
  av::Packet packet(av_packet_alloc());
  av::DecodedFrame frame(av_frame_alloc());
  const av::Decoder decoder = av::open_decoder(codec, [](AVCodecContext& context) {
    context.err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER;
    // libav's TIFF decoder refuses whole files when told to be strict, and cut ones always.
    if (context.codec_id != AV_CODEC_ID_TIFF) context.err_recognition |= AV_EF_EXPLODE;
    return true;
  });
  if (!decoder || !packet || !frame || av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0)
    return refused(AVERROR(ENOMEM));
  bytes.copy(reinterpret_cast<char*>(packet->data), bytes.size());
  int outcome = avcodec_send_packet(decoder.get(), packet.get());
  if (outcome >= 0) avcodec_send_packet(decoder.get(), nullptr);
  if (outcome >= 0) outcome = avcodec_receive_frame(decoder.get(), frame.get());
  if (outcome < 0 || av::is_damaged(*frame)) return refused(outcome);
  if (const std::string why = av::too_many_pixels({frame->width, frame->height}); !why.empty())
    return av::input_error(name, 0, why);
  return frame;
}

class PictureFile final : public Source {
 public:
  explicit PictureFile(Image<Rgb8> pixels) : pixels_(std::move(pixels)) {}
  Size size() const override { return pixels_.size(); }
  std::int64_t count() const override { return 1; }
  bool still() const override { return true; }
  Result<Next> next(Picture& into) override {
    if (given_) return Next::kEnd;
    given_ = true;
    into.pixels = pixels_.clone();
    into.jpeg.clear();
    into.t_ns = 0;
    into.sequence = 0;
    return Next::kNew;
  }

 private:
  Image<Rgb8> pixels_;
  bool given_ = false;
};

}  // namespace

bool is_picture(std::string_view head) { return picture_codec(head) != AV_CODEC_ID_NONE; }

Result<std::unique_ptr<Source>> open_picture(const std::filesystem::path& path) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;
  DUO_TRY_ASSIGN(const std::string bytes, read_file(path, kMaxBytes, "picture"));
  DUO_TRY_ASSIGN(const av::DecodedFrame frame, decode(bytes, "picture " + path.string()));
  Image<Rgb8> pixels;
  if (!av::ToRgb().convert(*frame, pixels))
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read picture {}: its size or kind of pixels is not supported; save it as an 8-bit PNG",
                             path.string())};
  return std::unique_ptr<Source>(std::make_unique<PictureFile>(std::move(pixels)));
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
