// Names in a batch's folder, and small JSON files in it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "duoptic/archive.h"

namespace duo {

inline constexpr char kManifest[] = "manifest.jsonl", kTasks[] = "tasks.txt", kHashes[] = "hashes.txt", kDone[] = "done",
                      kFailed[] = "failed", kFaults[] = "faults", kWork[] = "work", kDoneFile[] = "done.json",
                      kSums[] = "SHA256SUMS";
inline constexpr std::size_t kKeyLetters = 32;
inline constexpr std::size_t kMostText = std::size_t{1} << 30;  // bytes of a text in the folder

nlohmann::json to_json(const ArchiveTask& task);
/// Errors  it is none; `where` names it
Result<ArchiveTask> task_from(const nlohmann::json& json, const std::string& where);

/// Null where there is no such file, or where it holds no JSON object.
nlohmann::json read_json_object(const std::filesystem::path& path);
/// One line.
std::string text_of(const nlohmann::json& json);

/// From the root on, without "." and ".."; as it is where the folder that we are in is gone.
std::filesystem::path whole_path(const std::filesystem::path& path);
/// False where there is none, or nobody may look.
bool is_file(const std::filesystem::path& path);

/// Errors  the folder cannot be made
Result<void> make_folder(const std::filesystem::path& path);
/// What is in a folder, in order; nothing where there is none.
///
/// Errors  it cannot be read
Result<std::vector<std::string>> names_in(const std::filesystem::path& folder);
/// Twelve letters that nobody guesses.
std::string random_name();

/// A new name for a worker's folder: KEY.MACHINE.PROCESS.BEGAN.RANDOM, so that others can tell whether the worker lives.
std::string worker_name(const std::string& key);
/// On the worker's own machine exactly; elsewhere by when it last touched its folder.
bool lives(const std::filesystem::path& worker, std::filesystem::file_time_type now);
/// Of the file system of `folder`, whose clock may not be ours.
std::filesystem::file_time_type now_in(const std::filesystem::path& folder);
std::string host_name();

/// A task's own key, from the file of tasks by key; empty inputs: there is no such task.
///
/// Errors  the file cannot be read
Result<ArchiveTask> find_task(const std::filesystem::path& out, const std::string& key);

}  // namespace duo
