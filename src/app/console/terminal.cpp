// Uses libedit, with a key reader that also receives messages of the program.
#include "app/console/terminal.h"

#include <histedit.h>

#include <algorithm>
#include <cerrno>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cwchar>
#include <memory>

#include <fmt/format.h>

#include "app/console/history.h"
#include "app/console/session.h"
#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/system/signals.h"
#include "base/system/wait.h"

namespace limber::app {

namespace {

constexpr wchar_t kCancel = L'\x03';  // the key that Ctrl+C becomes for the editor
constexpr int kColumns = 80;

volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int) { interrupted = 1; }

bool consume_interrupt() {
  const bool was = interrupted != 0;
  interrupted = 0;
  return was;
}

class Terminal {
 public:
  explicit Terminal(console::ConsoleClient client);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  int run();

 private:
  static Terminal& of(EditLine* edit);
  static char* prompt(EditLine* edit);
  static int read_key(EditLine* edit, wchar_t* key);
  static unsigned char on_cancel(EditLine* edit, int key);
  static unsigned char on_tab(EditLine* edit, int key);

  int next_key(wchar_t* key);
  int decode(wchar_t* key);
  unsigned char complete();
  void list_words(const std::vector<std::string>& words) const;
  void remember(const std::string& line);

  ConsoleSession session_;
  ConsoleHistory saved_history_{ConsoleHistory::default_file()};
  EditLine* edit_ = nullptr;
  ::History* history_ = nullptr;
  std::string pending_;  // lines of an incomplete chunk
  bool canceled_ = false;
  std::mbstate_t bytes_{};  // state of an incomplete multibyte character
};

Terminal::Terminal(console::ConsoleClient client) : session_(std::move(client), consume_interrupt) {
  // only the character encoding; numbers keep the decimal point
  if (std::setlocale(LC_CTYPE, "") == nullptr || MB_CUR_MAX < 2) std::setlocale(LC_CTYPE, "C.UTF-8");
  history_ = history_init();
  HistEvent event;
  history(history_, &event, H_SETSIZE, static_cast<int>(ConsoleHistory::kMaxLines));
  for (const std::string& line : saved_history_.lines()) history(history_, &event, H_ENTER, line.c_str());

  edit_ = el_init("limber", stdin, stdout, stderr);
  el_set(edit_, EL_CLIENTDATA, this);
  el_set(edit_, EL_EDITOR, "emacs");
  el_set(edit_, EL_PROMPT, &Terminal::prompt);
  el_set(edit_, EL_SIGNAL, 0);
  el_set(edit_, EL_HIST, history, history_);
  el_set(edit_, EL_GETCFN, &Terminal::read_key);
  // with wide characters: of names in other strings, libedit makes copies that it never frees
  el_wset(edit_, EL_ADDFN, L"limber-cancel", L"Cancels the line", &Terminal::on_cancel);
  el_wset(edit_, EL_ADDFN, L"limber-complete", L"Completes a name", &Terminal::on_tab);
  el_set(edit_, EL_BIND, "^C", "limber-cancel", nullptr);
  el_set(edit_, EL_BIND, "^I", "limber-complete", nullptr);
  el_set(edit_, EL_BIND, "^R", "em-inc-search-prev", nullptr);

  // SIGINT is blocked except while waiting, which Ctrl+C then interrupts
  system::handle_signal(SIGINT, on_interrupt);
  system::block_signal(SIGINT);
}

Terminal::~Terminal() {
  el_end(edit_);
  history_end(history_);
}

Terminal& Terminal::of(EditLine* edit) {
  void* self = nullptr;
  el_get(edit, EL_CLIENTDATA, &self);
  return *static_cast<Terminal*>(self);
}

char* Terminal::prompt(EditLine* edit) {
  static char first[] = "limber> ";
  static char more[] = "     .. ";
  return of(edit).pending_.empty() ? first : more;
}

int Terminal::read_key(EditLine* edit, wchar_t* key) { return of(edit).next_key(key); }

unsigned char Terminal::on_cancel(EditLine* edit, int) {
  of(edit).canceled_ = true;
  return CC_NEWLINE;
}

unsigned char Terminal::on_tab(EditLine* edit, int) { return of(edit).complete(); }

// returns the next key; shows messages of the program above the edited line meanwhile
int Terminal::next_key(wchar_t* key) {
  std::fflush(stdout);
  while (true) {
    if (consume_interrupt()) {
      *key = kCancel;
      return 1;
    }
    system::PollEntry waiting[2] = {{.fd = system::kStandardInput}, {.fd = session_.ended() ? -1 : session_.fd()}};
    if (!system::wait_ready_or_signal(waiting, std::nullopt)) {
      if (errno != EINTR) return -1;
      continue;
    }
    if (waiting[1].ready && session_.has_messages()) {
      write_result("\r\x1b[K");
      session_.show_messages();
      el_set(edit_, EL_REFRESH);
    }
    if (session_.ended()) return 0;  // the end, as if by Ctrl+D
    if (!waiting[0].ready) continue;
    if (const int got = decode(key); got <= 1) return got;
  }
}

// returns 1: a character; 0: end of input; -1: error; 2: incomplete
int Terminal::decode(wchar_t* key) {
  char byte = 0;
  const std::ptrdiff_t got = system::read_some(system::kStandardInput, &byte, 1);
  if (got < 0 && errno == EAGAIN) return 2;
  if (got <= 0) return got == 0 ? 0 : -1;
  const std::size_t length = std::mbrtowc(key, &byte, 1, &bytes_);
  if (length == static_cast<std::size_t>(-2)) return 2;
  if (length == static_cast<std::size_t>(-1)) {
    bytes_ = {};
    return 2;  // invalid byte: skipped
  }
  return 1;
}

unsigned char Terminal::complete() {
  const LineInfo* line = el_line(edit_);
  const std::string before(line->buffer, line->cursor);
  std::size_t word = 0;
  std::vector<std::string> words = session_.complete(pending_ + before, word);
  if (words.empty()) return CC_REFRESH_BEEP;
  // the longest common prefix
  std::string common = words.front();
  for (const std::string& each : words) {
    const auto [end, other] = std::ranges::mismatch(common, each);
    common.erase(end, common.end());
  }
  if (common.size() > word) {
    el_insertstr(edit_, common.c_str() + word);
    return CC_REFRESH;
  }
  if (words.size() == 1) return CC_NORM;
  list_words(words);
  return CC_REDISPLAY;
}

void Terminal::list_words(const std::vector<std::string>& words) const {
  std::size_t widest = 0;
  for (const std::string& each : words) widest = std::max(widest, each.size());
  const std::size_t columns = std::max<std::size_t>(1, kColumns / (widest + 2));
  for (std::size_t i = 0; i < words.size(); i++) {
    if (i % columns == 0) write_result("\n");
    print_result("{:<{}}", words[i], widest + 2);
  }
  write_result("\n");
}

void Terminal::remember(const std::string& line) {
  HistEvent event;
  history(history_, &event, H_ENTER, line.c_str());
  saved_history_.add(line);
}

int Terminal::run() {
  while (true) {
    int count = 0;
    const char* typed = el_gets(edit_, &count);
    if (std::exchange(canceled_, false)) {
      write_result("^C\n");
      pending_.clear();
      continue;
    }
    if (typed == nullptr || count <= 0) break;
    std::string line(typed, static_cast<std::size_t>(count));
    while (line.ends_with('\n') || line.ends_with('\r')) line.pop_back();
    if (line.empty() && pending_.empty()) continue;
    remember(line);
    const ConsoleSession::EvaluationStatus status = session_.evaluate(pending_ + line);
    if (status == ConsoleSession::EvaluationStatus::incomplete) {
      pending_ += line + "\n";
      continue;
    }
    pending_.clear();
    if (status == ConsoleSession::EvaluationStatus::canceled)
      write_result(" (cancelled; the evaluation may still be running)\n");
  }
  print_result("{}\n", session_.ended() ? "\nlimber has ended" : "");
  return kSuccess;
}

}  // namespace

int console_terminal(console::ConnectedProgram program) {
  print_result("limber {}, process {}, plays {}. Lua console: Tab completes, Ctrl+C cancels a line, Ctrl+D exits.\n",
               program.hello.version, program.hello.pid, program.hello.text);
  return Terminal(std::move(program.client)).run();
}

}  // namespace limber::app
