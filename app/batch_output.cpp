// SPDX-License-Identifier: Apache-2.0
#include "app/batch_output.h"

#include <semaphore.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/unfinished_file.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::app {
namespace {

volatile std::sig_atomic_t first_signal = 0;

void onSignal(int signal) {
  if (first_signal == 0) first_signal = signal;
}

volatile std::sig_atomic_t end_signal = 0;
sem_t end_requests;

void onEndSignal(int signal) {
  const int error = errno;
  end_signal = signal;
  sem_post(&end_requests);
  errno = error;
}

void handleSignal(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

bool isIgnoredSignal(int signal) {
  struct sigaction action {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler == SIG_IGN;
}

/// Quoted for a shell.
std::string inQuotes(const std::string& word) {
  std::string text = "'";
  for (const char letter : word) text += letter == '\'' ? "'\\''" : std::string(1, letter);
  return text + "'";
}

}  // namespace

InterruptWatch::InterruptWatch(const std::stop_source& source) {
  first_signal = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) handleSignal(kSignals[i], onSignal);
  }
  thread_ = std::jthread([source](const std::stop_token& ended) {
    while (!ended.stop_requested()) {
      if (first_signal != 0) source.request_stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
}

InterruptWatch::~InterruptWatch() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

SignalEnd::SignalEnd() {
  sem_init(&end_requests, 0, 0);
  thread_ = std::jthread([](const std::stop_token& stop) {
    while (sem_wait(&end_requests) != 0) {
    }
    if (stop.stop_requested()) return;
    sessions::removeUnfinishedFiles();
    handleSignal(end_signal, SIG_DFL);
    kill(getpid(), end_signal);
  });
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!isIgnoredSignal(signal)) handleSignal(signal, onEndSignal);
}

SignalEnd::~SignalEnd() {
  thread_.request_stop();
  sem_post(&end_requests);
}

int InterruptWatch::signal() const { return first_signal; }

TerminalLine::TerminalLine() : on_terminal_(isatty(STDERR_FILENO) != 0) {}

void TerminalLine::show(const std::string& text) const {
  erase();
  if (on_terminal_) std::cerr << text;
}

/// By std::clog, which is stderr too: std::cerr lets no escape sequence pass.
void TerminalLine::erase() const {
  if (on_terminal_) std::clog << "\r\033[K" << std::flush;
}

std::string typedCommand() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  std::string text;
  for (std::string word; std::getline(stream, word, '\0');) {
    const bool plain = !word.empty() && word.find_first_of(" '\"\\$&|;<>()*?") == std::string::npos;
    text += (text.empty() ? "" : " ") + (plain ? word : inQuotes(word));
  }
  return text;
}

void writeResultLines(const std::string& file, const std::vector<sessions::RunResult>& results) {
  std::string text;
  for (const sessions::RunResult& result : results)
    text += sessions::compactJson(sessions::toJson(result)) + "\n";
  sessions::writeFileAtomically(file, text);
}

}  // namespace boresight::app
