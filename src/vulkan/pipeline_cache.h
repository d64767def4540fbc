// Pipeline cache on disk: a driver that compiled a kernel once need not do it again at the next start.
#pragma once

#include <filesystem>
#include <string>

namespace duo::vk {

/// Where the pipelines of a device and driver are kept: $XDG_CACHE_HOME/duoptic (else ~/.cache/duoptic). Empty: nowhere, since
/// neither is set.
std::filesystem::path pipeline_file(const std::string& device_id);

/// What write_pipelines() wrote; empty where the file is missing or damaged: some drivers crash on broken data.
std::string read_pipelines(const std::filesystem::path& file);

/// A failure to write is ignored: the next start compiles the kernels again.
void write_pipelines(const std::filesystem::path& file, const std::string& data);

}  // namespace duo::vk
