// Coded pictures that are damaged, though libav's decoders paint over what is wrong.
#pragma once

#include "core/libav.h"

namespace duo {

/// True where the packet is made of slices with checksums (FFV1 version 3, RFC 9043) and each of them is right.
bool ffv1_checks(const AVPacket& packet);

/// True where so many bytes of 0 follow each other as no encoder of this kind writes: a hole, as a copy from a bad disk or a
/// download that was broken off leaves. False for kinds that may write them.
bool has_hole(const AVPacket& packet, AVCodecID codec);

}  // namespace duo
