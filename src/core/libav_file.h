// What libav reads from and writes into: a file that is open already. Its name is never looked up again.
#pragma once

#include "core/libav.h"

namespace duo::av {

/// Lets the muxer write into `fd`, and read what it has written where it asks for the file again (MP4 moves its index to the
/// front). The file must stay open as long as the muxer lives.
///
/// Errors  a negative number of libav's
int write_into(AVFormatContext& muxer, int fd);

/// Hands all that libav still holds to the system.
///
/// Errors  a negative number of libav's, also that of an earlier write
int flush(AVFormatContext& muxer);

}  // namespace duo::av
