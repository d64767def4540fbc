// Pictures of JPEGs, which have a conversion of their own, beside libswscale's.
#include "sources/libav.h"

#include "tests/agree.h"

namespace duo {
namespace {

/// As ToRgb asks libswscale for other pictures.
Image<Rgb8> by_libswscale(const AVFrame& frame, AVPixelFormat format) {
  constexpr int kFlags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;
  const av::Scaler scaler(sws_getContext(frame.width, frame.height, format, frame.width, frame.height, AV_PIX_FMT_RGB24, kFlags,
                                         nullptr, nullptr, nullptr));
  constexpr int kOne = 1 << 16;
  sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(frame.colorspace), 1, sws_getCoefficients(SWS_CS_DEFAULT), 1, 0,
                           kOne, kOne);
  Image<Rgb8> out({frame.width, frame.height});
  std::uint8_t* planes[4] = {&out.row(0)->r};
  const int strides[4] = {static_cast<int>(out.stride() * 3)};
  EXPECT_EQ(sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, planes, strides), frame.height);
  return out;
}

TEST(ToRgb, JpegsAsLibswscaleDoes) {
  std::mt19937 rng(4);
  av::ToRgb to_rgb;
  for (const auto& [jpeg, plain] :
       {std::pair(AV_PIX_FMT_YUVJ420P, AV_PIX_FMT_YUV420P), std::pair(AV_PIX_FMT_YUVJ422P, AV_PIX_FMT_YUV422P)})
    for (const Size size : {Size{16, 16}, Size{34, 18}, Size{34, 18}, Size{160, 120}, Size{17, 16}, Size{16, 17}, Size{14, 2}})
      for (const AVColorSpace space : {AVCOL_SPC_BT470BG, AVCOL_SPC_BT709}) {
        const av::DecodedFrame frame(av_frame_alloc());
        frame->width = size.width, frame->height = size.height, frame->format = jpeg, frame->colorspace = space;
        ASSERT_GE(av_frame_get_buffer(frame.get(), 0), 0);
        for (int i = 0; i < 3; ++i) {
          const int rows = i == 0 || jpeg == AV_PIX_FMT_YUVJ422P ? size.height : (size.height + 1) / 2;
          for (int b = 0; b < rows * frame->linesize[i]; ++b)
            frame->data[i][b] = static_cast<std::uint8_t>(rng() % 4 == 0 ? rng() % 2 * 255 : rng());
        }
        Image<Rgb8> got;
        ASSERT_TRUE(to_rgb.convert(*frame, got));
        const Image<Rgb8> want = by_libswscale(*frame, plain);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            ASSERT_EQ(want.at(y, x), got.at(y, x)) << size.width << "x" << size.height << " " << plain << " " << x << "," << y;
      }
}

}  // namespace
}  // namespace duo
