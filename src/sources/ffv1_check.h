// Checksums of FFV1, which libav's decoder looks at and then paints over what is wrong.
#pragma once

#include "core/libav.h"

namespace duo {

/// True where the packet is made of slices with checksums (FFV1 version 3, RFC 9043) and each of them is right.
bool ffv1_checks(const AVPacket& packet);

}  // namespace duo
