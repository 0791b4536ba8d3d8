// Lines are written with the columns known so far; finish() appends empty cells for columns that were added later.
#include "export/writers.h"

#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/system/file.h"
#include "base/text.h"
#include "export/atomic_file.h"
#include "export/names.h"

namespace limber::exporter {

namespace {

// shortest text with the simulation's (single) precision
void append_number(std::string& line, double value) {
  fmt::format_to(std::back_inserter(line), ",{}", static_cast<float>(value));
}

class CsvWriter : public MotionWriter {
 public:
  explicit CsvWriter(const std::string& path) : path_(path), file_(std::in_place, path) {}

  Result<void> begin() { return file_->open(); }

  Result<void> add_body(const MotionBody& body) override {
    const std::string prefix = names_.unique(escape_name(body.name));
    const std::size_t before = columns_;
    for (const MotionLink& link : body.links) {
      for (const char* value : {"x", "y", "z", "qx", "qy", "qz", "qw"})
        add_column(fmt::format("{}/part/{}/{}", prefix, escape_name(link.name), value));
    }
    for (const MotionJoint& joint : body.joints) {
      for (const std::string& value : joint.values)
        add_column(fmt::format("{}/joint/{}/{}", prefix, escape_name(joint.name), value));
    }
    for (const std::string& extra : body.extras) add_column(fmt::format("{}/{}", prefix, extra));
    widths_.push_back(columns_ - before);
    return {};
  }

  Result<void> add_frame(double time, std::span<const MotionSample> bodies) override {
    line_.clear();
    if (column_changes_.empty()) line_ = header_ + "\n";
    if (column_changes_.empty() || column_changes_.back().columns != columns_)
      column_changes_.push_back({count_, columns_});
    count_++;
    line_ += number_text(time);
    for (std::size_t i = 0; i < bodies.size(); i++) {
      if (bodies[i].present) {
        add_sample(bodies[i]);
      } else {
        line_.append(widths_[i], ',');
      }
    }
    line_ += '\n';
    return file_->write(line_);
  }

  Result<void> finish() override {
    if (column_changes_.empty()) {
      if (Result<void> written = file_->write(header_ + "\n"); !written) return written;
    }
    if (column_changes_.size() <= 1) return file_->finish();
    if (Result<void> flushed = file_->flush(); !flushed) return flushed;
    return pad_lines();
  }

 private:
  // from line `first` on, lines have `columns` columns besides the time
  struct ColumnChange {
    std::uint64_t first = 0;
    std::size_t columns = 0;
  };

  void add_column(const std::string& name) {
    header_ += "," + csv_cell(name);
    columns_++;
  }

  void add_sample(const MotionSample& sample) {
    for (const Pose& pose : sample.links) {
      const Vec3& p = pose.position;
      const Quat& q = pose.rotation;
      for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) append_number(line_, value);
    }
    for (const double value : sample.values) append_number(line_, value);
    for (const double value : sample.extras) append_number(line_, value);
  }

  // copies the lines below the complete header and appends empty cells for columns that were added later
  Result<void> pad_lines() {
    AtomicFile padded(path_, temporary_name(path_ + ".whole"));
    const system::Descriptor in = system::open_file(file_->temporary_path(), system::OpenMode::read);
    if (!in.is_open()) return read_error();
    if (Result<void> opened = padded.open(); !opened) return opened;
    if (Result<void> written = padded.write(header_ + "\n"); !written) return written;
    std::string chunk(std::size_t{1} << 16u, '\0');
    std::string out;
    std::uint64_t line = 0;  // 0: the incomplete first header
    std::size_t change = 0;
    for (std::ptrdiff_t n = 0; (n = system::read_some(in.fd(), chunk.data(), chunk.size())) != 0;) {
      if (n < 0) return read_error();
      out.clear();
      for (const char c : std::string_view(chunk).substr(0, static_cast<std::size_t>(n))) {
        if (c == '\n') {
          if (line > 0) {
            while (change + 1 < column_changes_.size() && column_changes_[change + 1].first < line) change++;
            out.append(columns_ - column_changes_[change].columns, ',');
            out += '\n';
          }
          line++;
        } else if (line > 0) {
          out += c;
        }
      }
      if (Result<void> written = padded.write(out); !written) return written;
    }
    file_.reset();
    return padded.finish();
  }

  Error read_error() const {
    return Error{fmt::format("{} can't be read back: {}", printable(path_), std::generic_category().message(errno))};
  }

  std::string path_;
  std::optional<AtomicFile> file_;
  UniqueNames names_;
  std::string header_ = "time";
  std::string line_;
  std::size_t columns_ = 0;
  std::vector<std::size_t> widths_;  // by body: number of columns
  std::vector<ColumnChange> column_changes_;
  std::uint64_t count_ = 0;
};

}  // namespace

Result<std::unique_ptr<MotionWriter>> make_csv_writer(const std::string& path) {
  auto writer = std::make_unique<CsvWriter>(path);
  if (const Result<void> begun = writer->begin(); !begun) return Error{begun.error()};
  return std::unique_ptr<MotionWriter>(std::move(writer));
}

}  // namespace limber::exporter
