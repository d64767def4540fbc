// Files that a later start may use and nobody misses: the user's cache.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace duo {

/// The file of that name in $XDG_CACHE_HOME/duoptic (else ~/.cache/duoptic). Empty: nowhere, since neither is set.
std::filesystem::path cache_file(const std::string& name);

/// Makes the folder, too. A failure to write is ignored.
void write_cache_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace duo
