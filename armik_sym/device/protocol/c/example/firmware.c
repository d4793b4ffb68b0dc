#include "firmware.h"

#include "board.h"

#define SECOND_US UINT32_C(1000000)

static uint32_t period_us, due_us, info_us, sequence;

static void send(const uint8_t *wire, size_t size) {
  for (size_t i = 0; i < size; ++i) board_write(wire[i]);
}

static void send_info(void) {
  uint8_t wire[ARMIK_LONGEST_WIRE];
  send(wire, armik_encode_info(&board_info, wire));
}

static void read_channel(armik_sample *sample, uint8_t k) {
  if (board_info.kind[k] == ARMIK_POTENTIOMETER) {
    sample->counts[k] = board_adc(k);
    return;
  }
  sample->counts[k] = board_quadrature(k);
  if (board_index(k, &sample->index_counts[k])) sample->index = (uint8_t)(sample->index | (1u << k));
}

static void send_sample(uint32_t now_us) {
  armik_sample sample = {0};
  uint8_t wire[ARMIK_LONGEST_WIRE];
  sample.sequence = sequence;
  sample.time_us = now_us;
  sample.channels = board_info.channels;
  for (uint8_t k = 0; k < board_info.channels; ++k) read_channel(&sample, k);
  send(wire, armik_encode_sample(&sample, wire));
}

void firmware_start(void) {
  period_us = SECOND_US / board_info.rate_hz;
  sequence = 0;
  send_info();
  info_us = due_us = board_micros();
}

void firmware_step(void) {
  const uint32_t now_us = board_micros();
  const uint32_t late_us = now_us - due_us; /* half a turn of the clock or more: not due yet */
  uint32_t missed;
  if (late_us >= UINT32_C(0x80000000)) return;
  /* Samples there was no time for keep their numbers, so that the host sees how many are missing. */
  missed = late_us / period_us;
  sequence += missed;
  send_sample(now_us);
  ++sequence;
  due_us += (missed + 1) * period_us;
  if (now_us - info_us >= SECOND_US) {
    send_info();
    info_us += SECOND_US;
  }
}
