// SearchRecord: what defines a search, saved in its folder. Archive: the folder with the table and the presets of its
// elites. [main]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"
#include "experiments/axis.h"
#include "experiments/search.h"

namespace limber::app {

/// A result that a search improves.
struct Objective {
  std::string name;
  bool maximize = true;
  std::size_t index = 0;  ///< Among the results of the scene; not saved.

  /// 1, or -1 for the smallest value: searches maximize.
  double sign() const { return maximize ? 1 : -1; }
};

struct SearchRecord {
  std::string scene;       ///< As typed.
  std::string scene_path;  ///< Absolute. Not part of text().
  double duration = 0;     ///< s
  std::vector<std::uint64_t> seeds;
  std::vector<Objective> objectives;
  std::vector<experiments::Axis> axes;
  std::vector<experiments::ResultInfo> descriptors;
  experiments::Search::Algorithm algorithm = experiments::Search::Algorithm::cma_es;
  std::size_t population = 0;
  std::uint64_t search_seed = 1;

  /// Without a module.
  experiments::Search::Options options() const;
  /// Returns the record as JSON, and parses it. The path is not part of it, so that a scene can be moved.
  std::string text() const;
  static Result<SearchRecord> parse(std::string_view text);
  /// Returns the name of the first entry in which the records differ; empty: none. Equal records give the same search.
  static std::string difference(std::string_view a, std::string_view b);

  /// Returns the values of the parameters.
  std::vector<double> values(const std::vector<double>& individual) const;
  /// Returns the shell command that plays an elite with the first seed.
  std::string play_command(const experiments::Elite& elite) const;
  /// Returns the names of the elites: best_N, front_N, or cell_I_K with the cells of the descriptors, from 1.
  std::vector<std::string> names(const std::vector<experiments::Elite>& elites) const;
};

/// Returns the index of the elite that is best in the first objective. Requires at least one.
std::size_t best_of(const std::vector<experiments::Elite>& elites, std::size_t objective = 0);

class Archive {
 public:
  /// Maximum number of elites that are presets: the best ones.
  static constexpr std::size_t kMaxPresets = 5000;

  explicit Archive(std::string folder) : folder_(std::move(folder)) {}

  const std::string& folder() const { return folder_; }
  std::string state_file() const { return folder_ + "/state.json"; }
  std::string preset_file() const { return folder_ + "/elites.presets.json"; }
  /// Replaces elites.csv.
  Result<void> write_table(const SearchRecord& record, const std::vector<experiments::Elite>& elites) const;
  /// Replaces the presets of earlier elites; those that a show has stored stay. `locks`: folder of lock files.
  Result<void> write_presets(const SearchRecord& record, const std::vector<experiments::Elite>& elites,
                             const std::string& locks) const;

 private:
  std::string folder_;
};

/// Replaces a file atomically.
Result<void> write_archive_file(const std::string& path, std::string_view text);

}  // namespace limber::app
