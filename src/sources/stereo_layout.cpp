#include "sources/stereo_layout.h"

extern "C" {
#include <libavutil/stereo3d.h>
}

namespace duo {

std::optional<ViewLayout> layout_of(const AVStream& stream, const AVFrame& frame, std::string& name) {
  std::size_t bytes = 0;
  const auto* stereo = reinterpret_cast<const AVStereo3D*>(av_stream_get_side_data(&stream, AV_PKT_DATA_STEREO3D, &bytes));
  if (stereo == nullptr || stereo->type == AV_STEREO3D_2D)
    if (const AVFrameSideData* data = av_frame_get_side_data(&frame, AV_FRAME_DATA_STEREO3D); data != nullptr)
      stereo = reinterpret_cast<const AVStereo3D*>(data->data);
  if (stereo == nullptr || stereo->type == AV_STEREO3D_2D) return std::nullopt;
  const bool right_first = (stereo->flags & AV_STEREO3D_FLAG_INVERT) != 0;
  if (stereo->type == AV_STEREO3D_SIDEBYSIDE) return right_first ? ViewLayout::kRightLeft : ViewLayout::kSideBySide;
  if (stereo->type == AV_STEREO3D_TOPBOTTOM) return right_first ? ViewLayout::kBottomTop : ViewLayout::kTopBottom;
  name = av_stereo3d_type_name(static_cast<unsigned>(stereo->type));
  return std::nullopt;
}

}  // namespace duo
