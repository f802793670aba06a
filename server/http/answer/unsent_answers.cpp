
#include "server/http/answer/unsent_answers.h"

#include <algorithm>

namespace fleetplan::server {

UnsentAnswers::Stats UnsentAnswers::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

void UnsentAnswers::keep(Answer& answer, std::string_view rest) {
  const std::lock_guard lock(mutex_);
  make_room(rest.size(), answer);
  const std::lock_guard text_lock(answer.mutex_);
  if (answer.dropped_) return;
  answer.text_.erase(0, answer.sent_);
  answer.sent_ = 0;
  answer.text_.append(rest);
  if (!answer.is_held_) held_.push_back(&answer);
  answer.is_held_ = true;
  stats_.bytes += answer.text_.size() - answer.counted_;
  answer.counted_ = answer.text_.size();
  answer.accepted_at_ = Answer::Clock::now();
}

void UnsentAnswers::accepted(Answer& answer) {
  const std::lock_guard lock(mutex_);
  answer.accepted_at_ = Answer::Clock::now();
}

void UnsentAnswers::forget(Answer& answer) {
  const std::lock_guard lock(mutex_);
  forget_locked(answer);
}

void UnsentAnswers::forget_locked(Answer& answer) {
  if (!answer.is_held_) return;
  std::erase(held_, &answer);
  answer.is_held_ = false;
  stats_.bytes -= answer.counted_;
  answer.counted_ = 0;
}

/// Drops other answers until so many bytes more are within the budget, or none is left. The mutex is locked.
void UnsentAnswers::make_room(std::size_t bytes, const Answer& newest) {
  const auto before = [&](const Answer* a, const Answer* b) {
    if ((a == &newest) != (b == &newest)) return b == &newest;
    return a->accepted_at_ < b->accepted_at_;
  };
  while (stats_.bytes > 0 && bytes + stats_.bytes > max_bytes_) {
    Answer& slowest = **std::min_element(held_.begin(), held_.end(), before);
    if (&slowest == &newest) return;
    {
      const std::lock_guard text_lock(slowest.mutex_);
      slowest.dropped_ = true;
      slowest.text_ = std::string();
      slowest.sent_ = 0;
    }
    slowest.socket_.hang_up();  // its connection goes on, and ends
    forget_locked(slowest);
    ++stats_.dropped;
  }
}

bool UnsentAnswers::Answer::send(std::string_view data) {
  if (!has_rest()) {
    const auto sent = socket_.write_some(data);
    if (!sent) return false;
    data.remove_prefix(*sent);
  }
  if (!data.empty()) all_.keep(*this, data);
  const std::lock_guard lock(mutex_);
  return !dropped_;
}

std::optional<std::size_t> UnsentAnswers::Answer::send_rest() {
  std::optional<std::size_t> sent;
  bool is_over = false;
  {
    const std::lock_guard lock(mutex_);
    if (dropped_) return std::nullopt;
    sent = socket_.write_some(std::string_view(text_).substr(sent_));
    sent_ += sent.value_or(0);
    is_over = sent_ == text_.size();
    if (is_over) {
      text_ = std::string();
      sent_ = 0;
    }
  }
  if (is_over) {
    all_.forget(*this);
  } else if (sent && *sent > 0) {
    all_.accepted(*this);
  }
  return sent;
}

bool UnsentAnswers::Answer::has_rest() const {
  const std::lock_guard lock(mutex_);
  return dropped_ || !text_.empty();
}

std::size_t UnsentAnswers::Answer::rest() const {
  const std::lock_guard lock(mutex_);
  return text_.size() - sent_;
}

}  // namespace fleetplan::server
