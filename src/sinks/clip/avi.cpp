#include "sinks/clip/avi.h"

#include <fmt/format.h>

#include "core/coded_picture.h"
#include "core/libav_file.h"

namespace duo {

Error AviWriter::failed(int error) const {
  return {is_exhausted(AVUNERROR(error)) ? ErrorCode::kExhausted : ErrorCode::kWriteFailed,
          fmt::format("cannot write video '{}': {}; free some space or write elsewhere", name_, av::reason(error))};
}

Result<AviWriter> AviWriter::open(const std::filesystem::path& path, Size size, int frames_per_second, int jpeg_quality) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  AviWriter video(std::move(file), shown(path).string(), frames_per_second, jpeg_quality);
  video.packet_.reset(av_packet_alloc());
  AVFormatContext* muxer = nullptr;
  if (const int e = avformat_alloc_output_context2(&muxer, nullptr, "avi", nullptr); e < 0) return video.failed(e);
  video.muxer_.reset(muxer);
  muxer->flags |= AVFMT_FLAG_BITEXACT;  // no date inside
  AVStream* stream = avformat_new_stream(muxer, nullptr);
  if (stream == nullptr || !video.packet_) return video.failed(AVERROR(ENOMEM));
  stream->time_base = av_inv_q(video.rate_);
  stream->avg_frame_rate = stream->r_frame_rate = video.rate_;
  stream->codecpar->codec_type = AVMEDIA_TYPE_VIDEO;
  stream->codecpar->codec_id = AV_CODEC_ID_MJPEG;
  stream->codecpar->width = size.width;
  stream->codecpar->height = size.height;
  stream->codecpar->format = AV_PIX_FMT_YUVJ420P;
  if (const int e = av::write_into(*muxer, video.file_.fd()); e < 0) return video.failed(e);
  if (const int e = avformat_write_header(muxer, nullptr); e < 0) return video.failed(e);
  return video;
}

Result<void> AviWriter::write(View<const Rgb8> picture) {
  const std::string jpeg = jpeg_of(picture, quality_);
  if (jpeg.empty()) return failed(AVERROR_ENCODER_NOT_FOUND);
  if (const int e = av_new_packet(packet_.get(), static_cast<int>(jpeg.size())); e < 0) return failed(e);
  std::copy(jpeg.begin(), jpeg.end(), packet_->data);
  packet_->flags |= AV_PKT_FLAG_KEY;
  packet_->pts = packet_->dts = count_++;
  packet_->duration = 1;
  av_packet_rescale_ts(packet_.get(), av_inv_q(rate_), muxer_->streams[0]->time_base);
  if (const int e = av_interleaved_write_frame(muxer_.get(), packet_.get()); e < 0) return failed(e);
  if (muxer_->pb->error < 0) return failed(muxer_->pb->error);
  return {};
}

Result<void> AviWriter::finish() {
  if (const int e = av_write_trailer(muxer_.get()); e < 0) return failed(e);
  if (const int e = av::flush(*muxer_); e < 0) return failed(e);
  return file_.publish();
}

}  // namespace duo
