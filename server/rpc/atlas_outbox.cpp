// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_outbox.h"

#include <utility>

namespace viewloom {

std::optional<grpc::ByteBuffer> AtlasAnnouncements::take(const EncodedAtlas& atlas) {
  if (layout_message_.empty() || layout_ != atlas.layout) {
    std::string message = layoutMessage(atlas);
    layout_ = atlas.layout;
    if (message != layout_message_) {
      layout_message_ = std::move(message);
      const grpc::Slice slice(layout_message_);
      return grpc::ByteBuffer(&slice, 1);
    }
  }
  if (skipped_count_ > 0) return skippedMessage(std::exchange(skipped_count_, 0));
  return std::nullopt;
}

void AtlasOutbox::restart(std::shared_ptr<AtlasReader> reader) {
  close(false);
  sends_earlier_ = sending_.has_value();
  queue_.clear();
  reader_ = std::move(reader);
  begun_sequence_ = 0;  // of another display the sequence starts anew
  announcements_.restart();
  sent_poses_.clear();
}

void AtlasOutbox::begin(GrowingAtlasPtr atlas, size_t viewer_count) {
  growing_.emplace(std::move(atlas), viewer_count);
}

void AtlasOutbox::offer(AtlasPtr atlas) {
  if (growing_ && growing_->atlas().sequence <= atlas->sequence) growing_.reset();
  if (atlas->sequence <= begun_sequence_) return;
  const size_t missed_count = queue_.offer(std::move(atlas));
  if (missed_count == 0) return;
  announcements_.noteSkipped(missed_count);
  metrics_.replaced[HandOver::kGrpc].add(double(missed_count));
}

void AtlasOutbox::close(bool is_draining) {
  growing_.reset();
  if (!is_draining) queue_.dropWaiting();
  if (sending_) sending_->giveUp();
}

bool AtlasOutbox::mayBegin() {
  if (count_ != 0 && sent_count_ >= count_) return false;
  if (growing_ && growing_->state() == GrowingAtlas::State::kAbandoned) growing_.reset();
  if (!queue_.isEmpty()) return true;
  return growing_ && queue_.mayBeNext(growing_->atlas()) && growing_->mayBegin(reader_);
}

std::optional<grpc::ByteBuffer> AtlasOutbox::takeBefore(bool may_begin) {
  if (sending_ || !may_begin || !mayBegin()) return std::nullopt;
  const bool is_whole = !queue_.isEmpty();
  const EncodedAtlas& next = is_whole ? queue_.front() : growing_->atlas();
  std::optional<grpc::ByteBuffer> message = announcements_.take(next);
  if (message) return message;
  begun_sequence_ = next.sequence;
  sent_poses_.note(next.sequence, next.eye_poses_time_ns);
  if (is_whole) {
    sending_.emplace(std::make_shared<GrowingAtlas>(queue_.take().atlas));
  } else {
    queue_.noteTaken(next);
    sending_.emplace(*std::exchange(growing_, std::nullopt));
  }
  return std::nullopt;
}

std::optional<grpc::ByteBuffer> AtlasOutbox::take(bool may_begin) {
  has_ended_atlas_ = false;
  std::optional<grpc::ByteBuffer> message = takeBefore(may_begin);
  if (!message && sending_) {
    message = sending_->next(reader_);
    if (sending_->done()) {
      if (sending_->wasWhole()) {
        ++sent_count_;
        metrics_.atlases_sent[Transport::kGrpc].add();
      } else if (!sends_earlier_) {
        queue_.noteLost(sending_->atlas().sequence);
      }
      sending_.reset();
      sends_earlier_ = false;
      has_ended_atlas_ = true;
    }
  }
  if (message) metrics_.sent_bytes[Transport::kGrpc].add(static_cast<double>(message->Length()));
  return message;
}

}  // namespace viewloom
