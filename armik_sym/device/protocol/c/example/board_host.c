/* A board that is a computer: its sensors swing evenly to and fro, its serial port is the standard output.
 *
 *   cc -std=c99 -I.. firmware.c board_host.c ../armik_frame.c -o board
 *   ./board 2.5 > seconds_of_bytes
 *   ./board 10 4290000000 > clock_that_overflows
 *
 * The second number is where the clock starts. It is simulated: the bytes are the same in every run. */
#include <stdio.h>
#include <stdlib.h>

#include "board.h"
#include "firmware.h"

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

#define LOOP_US 20u /* what one turn of a main loop takes */
#define COUNTS_PER_TURN 4000

const armik_info board_info = {
    .device_id = 2021,
    .rate_hz = 500,
    .channels = 5,
    .kind = {ARMIK_POTENTIOMETER, ARMIK_POTENTIOMETER, ARMIK_POTENTIOMETER, ARMIK_ENCODER, ARMIK_ENCODER},
    .span = {4096, 4096, 4096, COUNTS_PER_TURN, COUNTS_PER_TURN},
    .firmware = "example 1.0"};

static uint32_t start_us = 0;
static uint32_t elapsed_us = 0;
static int32_t latest_turn[ARMIK_MOST_CHANNELS];

/* Up and down between 0 and height, once in a period. */
static int32_t swing(int32_t height, uint32_t period_us) {
  const uint32_t half = period_us / 2, phase = elapsed_us % period_us;
  const uint32_t way = phase < half ? phase : period_us - phase;
  return (int32_t)((int64_t)height * way / half);
}

/* Position of an encoder's shaft since it was switched on: more than two overflows of its register. */
static int32_t position(uint8_t channel) { return swing(140000, UINT32_C(8000000) >> (channel & 1)) - 2000; }

/* Whole turns up to a position, rounded down. */
static int32_t turn(int32_t at) {
  return at >= 0 ? at / COUNTS_PER_TURN : -((COUNTS_PER_TURN - 1 - at) / COUNTS_PER_TURN);
}

uint32_t board_micros(void) {
  elapsed_us += LOOP_US;
  return start_us + elapsed_us;
}

uint16_t board_adc(uint8_t channel) {
  return (uint16_t)(300 + swing(3400, UINT32_C(2000000) + UINT32_C(700000) * channel));
}

uint16_t board_quadrature(uint8_t channel) { return (uint16_t)((uint32_t)position(channel) & 0xFFFFu); }

uint8_t board_index(uint8_t channel, uint16_t *latched) {
  const int32_t now = turn(position(channel)), before = latest_turn[channel];
  /* Upwards the pulse stands at the start of the turn entered, downwards at that of the turn left. */
  const int32_t pulse = (now > before ? now : now + 1) * COUNTS_PER_TURN;
  latest_turn[channel] = now;
  if (now == before) return 0;
  *latched = (uint16_t)((uint32_t)pulse & 0xFFFFu);
  return 1;
}

void board_write(uint8_t byte) {
  if (putchar(byte) == EOF) exit(EXIT_FAILURE);
}

int main(int count, char **arguments) {
  const double seconds = count > 1 ? atof(arguments[1]) : 10.0;
  if (count > 2) start_us = (uint32_t)strtoul(arguments[2], NULL, 10);
#ifdef _WIN32
  _setmode(_fileno(stdout), _O_BINARY);
#endif
  for (uint8_t k = 0; k < board_info.channels; ++k) latest_turn[k] = turn(position(k));
  firmware_start();
  while (elapsed_us < seconds * 1e6) firmware_step();
  return fflush(stdout) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
