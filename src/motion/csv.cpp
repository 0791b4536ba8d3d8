// Rows have the columns that are known when they are written; those that came later are added at the end.
#include "motion/csv.h"

#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/text.h"
#include "motion/names.h"
#include "motion/out_file.h"

namespace limber {

namespace {

// a column's name: what OSC would have changed is changed, so only quotes are left to be doubled
std::string cell_of(const std::string& name) {
  if (name.find_first_of("\",\n\r") == std::string::npos) return name;
  std::string out = "\"";
  for (const char c : name) out.append(c == '"' ? 2 : 1, c);
  return out + "\"";
}

// as exact as the simulation is, as short as can be
void append_number(std::string& row, double value) {
  fmt::format_to(std::back_inserter(row), ",{}", static_cast<float>(value));
}

class CsvWriter : public MotionWriter {
 public:
  explicit CsvWriter(const std::string& path) : path_(path), rows_(std::in_place, path) {}

  Result<void> begin() { return rows_->open(); }

  Result<void> add_body(const MotionBody& body) override {
    const std::string place = names_.unique(escape_name(body.name));
    const std::size_t before = columns_;
    for (const MotionLink& link : body.links) {
      for (const char* value : {"x", "y", "z", "qx", "qy", "qz", "qw"})
        add_column(fmt::format("{}/part/{}/{}", place, escape_name(link.name), value));
    }
    for (const MotionJoint& joint : body.joints) {
      for (const std::string& value : joint.values)
        add_column(fmt::format("{}/joint/{}/{}", place, escape_name(joint.name), value));
    }
    widths_.push_back(columns_ - before);
    return {};
  }

  Result<void> add_frame(double time, std::span<const MotionSample> bodies) override {
    row_.clear();
    if (eras_.empty()) row_ = header_ + "\n";
    if (eras_.empty() || eras_.back().columns != columns_) eras_.push_back({count_, columns_});
    count_++;
    row_ += number_text(time);
    for (std::size_t i = 0; i < bodies.size(); i++) {
      if (bodies[i].there) {
        add_sample(bodies[i]);
      } else {
        row_.append(widths_[i], ',');
      }
    }
    row_ += '\n';
    return rows_->put(row_);
  }

  Result<void> finish() override {
    if (eras_.empty()) {
      if (Result<void> put = rows_->put(header_ + "\n"); !put) return put;
    }
    if (eras_.size() <= 1) return rows_->finish();
    if (Result<void> flushed = rows_->flush(); !flushed) return flushed;
    return widen();
  }

 private:
  // rows from that number on have so many columns beside the time
  struct Era {
    std::uint64_t first = 0;
    std::size_t columns = 0;
  };

  void add_column(const std::string& name) {
    header_ += "," + cell_of(name);
    columns_++;
  }

  void add_sample(const MotionSample& sample) {
    for (const Pose& pose : sample.links) {
      const Vec3& p = pose.position;
      const Quat& q = pose.rotation;
      for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) append_number(row_, value);
    }
    for (const double value : sample.values) append_number(row_, value);
  }

  // the rows again, under the whole header, each with an empty cell for every column that it did not know
  Result<void> widen() {
    OutFile whole(path_, beside_name(path_ + ".whole"));
    const system::Descriptor in = system::open_file(rows_->beside(), system::OpenMode::read);
    if (!in.open()) return read_fault();
    if (Result<void> opened = whole.open(); !opened) return opened;
    if (Result<void> put = whole.put(header_ + "\n"); !put) return put;
    std::string piece(std::size_t{1} << 16u, '\0');
    std::string out;
    std::uint64_t line = 0;  // 0: the first header, which was too short
    std::size_t era = 0;
    for (std::ptrdiff_t n = 0; (n = system::read_some(in.fd(), piece.data(), piece.size())) != 0;) {
      if (n < 0) return read_fault();
      out.clear();
      for (const char c : std::string_view(piece).substr(0, static_cast<std::size_t>(n))) {
        if (c == '\n') {
          if (line > 0) {
            while (era + 1 < eras_.size() && eras_[era + 1].first < line) era++;
            out.append(columns_ - eras_[era].columns, ',');
            out += '\n';
          }
          line++;
        } else if (line > 0) {
          out += c;
        }
      }
      if (Result<void> put = whole.put(out); !put) return put;
    }
    rows_.reset();
    return whole.finish();
  }

  Error read_fault() const {
    return Error{fmt::format("{} can't be written: {}", printable(path_), std::generic_category().message(errno))};
  }

  std::string path_;
  std::optional<OutFile> rows_;
  UniqueNames names_;
  std::string header_ = "time";
  std::string row_;
  std::size_t columns_ = 0;
  std::vector<std::size_t> widths_;  // of the bodies
  std::vector<Era> eras_;
  std::uint64_t count_ = 0;
};

}  // namespace

Result<std::unique_ptr<MotionWriter>> write_csv(const std::string& path) {
  auto writer = std::make_unique<CsvWriter>(path);
  if (const Result<void> begun = writer->begin(); !begun) return Error{begun.error()};
  return std::unique_ptr<MotionWriter>(std::move(writer));
}

}  // namespace limber
