// Network streams and GStreamer pipelines as live sources.
#pragma once

#include <memory>
#include <string>

#include "duoptic/source.h"

namespace duo {

/// True for http://, https://, rtsp:// and gst: followed by a pipeline.
bool is_stream_name(const std::string& name);

/// Opens a stream: an address through libav, a pipeline with gst-launch-1.0. Its pictures are stamped when they arrive; one
/// that breaks off is opened again. Nothing waits for a stream that hangs.
///
/// Errors  it cannot be opened, or gives no picture within 10 s
Result<std::unique_ptr<Source>> open_stream(const std::string& name);

}  // namespace duo
