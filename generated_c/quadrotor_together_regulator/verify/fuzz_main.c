/* Calls every entry of quadrotor_together_regulator with plausible and implausible values,
     and looks at what each call leaves behind.
 * Written by plantc 0.1.0 from model 1eed9805.
 *
 * After a refused call memory and outputs must be bit for bit what they were. After any other call the memory must be
 * within its stated ranges; and where the parameters are within theirs, outputs that are judged must be within theirs,
 * and all others finite. A sequence of calls starts from init,
     or from any memory within its ranges. Built with quadrotor_together_regulator.c alone it is a program of its own, with its own
 * random numbers; a clang with libFuzzer looks for new paths instead:
 *
 *     cc -O1 -I src src/quadrotor_together_regulator.c verify/fuzz_main.c -lm -o fuzz && ./fuzz 1000000
 *     clang -O1 -g -DWITH_LIBFUZZER -fsanitize=fuzzer,address,undefined -I src src/quadrotor_together_regulator.c verify/fuzz_main.c \
 *         -lm -o fuzz && ./fuzz -max_total_time=60
 *
 * ./fuzz [CALLS [SEED]] makes that many calls; ./fuzz FILE... replays inputs that libFuzzer kept. Returns 0 if nothing
 * was lost.
 * This file belongs to whoever exported it; no licence of plantc applies to it.
 */
#include "quadrotor_together_regulator.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_INPUT 4096U
#define LONGEST_SEQUENCE 64U
#define PRINTED 10UL

typedef float real_t;

typedef enum
{
    KIND_REAL,
    KIND_FLAG,
    KIND_COUNT,
    KIND_STATUS
} kind_t;

typedef struct
{
    real_t low;
    real_t high;
} range_t;

/* A field of a struct. Element i has the range first + i * stride of the table; order is that of a packed symmetric
 * matrix, else 0. */
typedef struct
{
    const char *name;
    size_t offset;
    uint32_t size;
    kind_t kind;
    uint32_t first;
    uint32_t stride;
    uint32_t order;
} field_t;

typedef struct
{
    const field_t *fields;
    uint32_t count;
} fields_t;

typedef struct
{
    const char *name;
    void *in;
    fields_t in_fields;
    void *out;
    size_t out_size;
    fields_t out_fields;
    quadrotor_together_regulator_status_t (*call)(void);
} entry_t;

/* What is left of an input. */
typedef struct
{
    const uint8_t *at;
    size_t left;
} bytes_t;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* --- what there is ------------------------------------------------------------------------------------------------ */

static const range_t ranges[] = {
    { 0.0f, 1000000.0f },
    { 1.0e-12f, 1000000.0f },
    { 1.0f, 1000000.0f },
    { -10000.0f, 10000.0f },
    { -30.0f, 30.0f },
    { -1000.0f, 1000.0f },
    { -1000000.0f, 1000000.0f },
    { 1.0e-20f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { 1.0e-20f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { 1.0e-20f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { 1.0e-20f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { 1.0e-20f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { 1.0e-20f, 1.0e9f },
    { -1.0e9f, 1.0e9f },
    { 1.0e-20f, 1.0e9f },
    { -10.0f, 10.0f },
    { -FLT_MAX, FLT_MAX }
};

static const field_t state_fields[] = {
    { "generator.w_x", offsetof(quadrotor_together_regulator_state_t, generator.w_x), 7U, KIND_REAL, 6U, 0U, 0U },
    { "generator.w_y", offsetof(quadrotor_together_regulator_state_t, generator.w_y), 7U, KIND_REAL, 6U, 0U, 0U },
    { "generator.w_z", offsetof(quadrotor_together_regulator_state_t, generator.w_z), 7U, KIND_REAL, 6U, 0U, 0U },
    { "generator.w_yaw", offsetof(quadrotor_together_regulator_state_t, generator.w_yaw), 7U, KIND_REAL, 6U, 0U, 0U },
    { "generator.covariance", offsetof(quadrotor_together_regulator_state_t, generator.covariance), 28U,
     KIND_REAL, 7U, 1U, 7U },
    { "generator.rejected_readings", offsetof(quadrotor_together_regulator_state_t, generator.rejected_readings),
     1U, KIND_COUNT, 0U, 0U, 0U }
};

static const field_t params_fields[] = {
    { "generator.variance_step", offsetof(quadrotor_together_regulator_params_t, generator.variance_step), 7U,
     KIND_REAL, 0U, 0U, 0U },
    { "generator.variance_readings", offsetof(quadrotor_together_regulator_params_t,
     generator.variance_readings), 1U, KIND_REAL, 1U, 0U, 0U },
    { "generator.gate_readings", offsetof(quadrotor_together_regulator_params_t, generator.gate_readings), 1U,
     KIND_REAL, 0U, 0U, 0U },
    { "generator.reject_limit", offsetof(quadrotor_together_regulator_params_t, generator.reject_limit), 1U,
     KIND_COUNT, 0U, 0U, 0U },
    { "generator.inflation", offsetof(quadrotor_together_regulator_params_t, generator.inflation), 1U, KIND_REAL,
     2U, 0U, 0U },
    { "generator.variance_0", offsetof(quadrotor_together_regulator_params_t, generator.variance_0), 7U,
     KIND_REAL, 1U, 0U, 0U },
    { "feedback.x", offsetof(quadrotor_together_regulator_params_t, feedback.x), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback.vx", offsetof(quadrotor_together_regulator_params_t, feedback.vx), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback.y", offsetof(quadrotor_together_regulator_params_t, feedback.y), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback.vy", offsetof(quadrotor_together_regulator_params_t, feedback.vy), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback.z", offsetof(quadrotor_together_regulator_params_t, feedback.z), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback.vz", offsetof(quadrotor_together_regulator_params_t, feedback.vz), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback.roll", offsetof(quadrotor_together_regulator_params_t, feedback.roll), 1U, KIND_REAL, 4U, 0U, 0U },
    { "feedback.roll_rate", offsetof(quadrotor_together_regulator_params_t, feedback.roll_rate), 1U, KIND_REAL,
     5U, 0U, 0U },
    { "feedback.pitch", offsetof(quadrotor_together_regulator_params_t, feedback.pitch), 1U, KIND_REAL, 4U, 0U, 0U },
    { "feedback.pitch_rate", offsetof(quadrotor_together_regulator_params_t, feedback.pitch_rate), 1U, KIND_REAL,
     5U, 0U, 0U },
    { "feedback.yaw", offsetof(quadrotor_together_regulator_params_t, feedback.yaw), 1U, KIND_REAL, 4U, 0U, 0U },
    { "feedback.yaw_rate", offsetof(quadrotor_together_regulator_params_t, feedback.yaw_rate), 1U, KIND_REAL, 5U,
     0U, 0U },
    { "feedback.rotor_1", offsetof(quadrotor_together_regulator_params_t, feedback.rotor_1), 1U, KIND_REAL, 3U,
     0U, 0U },
    { "feedback.rotor_2", offsetof(quadrotor_together_regulator_params_t, feedback.rotor_2), 1U, KIND_REAL, 3U,
     0U, 0U },
    { "feedback.rotor_3", offsetof(quadrotor_together_regulator_params_t, feedback.rotor_3), 1U, KIND_REAL, 3U,
     0U, 0U },
    { "feedback.rotor_4", offsetof(quadrotor_together_regulator_params_t, feedback.rotor_4), 1U, KIND_REAL, 3U, 0U, 0U }
};

static const field_t step_in_fields[] = {
    { "generator_has_readings", offsetof(quadrotor_together_regulator_step_in_t, generator_has_readings), 1U,
     KIND_FLAG, 0U, 0U, 0U },
    { "generator_readings", offsetof(quadrotor_together_regulator_step_in_t, generator_readings), 4U, KIND_REAL,
     35U, 0U, 0U },
    { "feedback_x", offsetof(quadrotor_together_regulator_step_in_t, feedback_x), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback_vx", offsetof(quadrotor_together_regulator_step_in_t, feedback_vx), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback_y", offsetof(quadrotor_together_regulator_step_in_t, feedback_y), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback_vy", offsetof(quadrotor_together_regulator_step_in_t, feedback_vy), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback_z", offsetof(quadrotor_together_regulator_step_in_t, feedback_z), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback_vz", offsetof(quadrotor_together_regulator_step_in_t, feedback_vz), 1U, KIND_REAL, 3U, 0U, 0U },
    { "feedback_roll", offsetof(quadrotor_together_regulator_step_in_t, feedback_roll), 1U, KIND_REAL, 4U, 0U, 0U },
    { "feedback_roll_rate", offsetof(quadrotor_together_regulator_step_in_t, feedback_roll_rate), 1U, KIND_REAL,
     5U, 0U, 0U },
    { "feedback_pitch", offsetof(quadrotor_together_regulator_step_in_t, feedback_pitch), 1U, KIND_REAL, 4U, 0U, 0U },
    { "feedback_pitch_rate", offsetof(quadrotor_together_regulator_step_in_t, feedback_pitch_rate), 1U,
     KIND_REAL, 5U, 0U, 0U },
    { "feedback_yaw", offsetof(quadrotor_together_regulator_step_in_t, feedback_yaw), 1U, KIND_REAL, 4U, 0U, 0U },
    { "feedback_yaw_rate", offsetof(quadrotor_together_regulator_step_in_t, feedback_yaw_rate), 1U, KIND_REAL,
     5U, 0U, 0U }
};

static const field_t step_out_fields[] = {
    { "generator.status_readings", offsetof(quadrotor_together_regulator_step_out_t, generator.status_readings),
     1U, KIND_STATUS, 0U, 0U, 0U },
    { "generator.readings.innovation", offsetof(quadrotor_together_regulator_step_out_t,
     generator.readings.innovation), 4U, KIND_REAL, 36U, 0U, 0U },
    { "generator.readings.variance", offsetof(quadrotor_together_regulator_step_out_t,
     generator.readings.variance), 1U, KIND_REAL, 36U, 0U, 0U },
    { "generator.readings.nis", offsetof(quadrotor_together_regulator_step_out_t, generator.readings.nis), 1U,
     KIND_REAL, 36U, 0U, 0U },
    { "feedback.rotor_1", offsetof(quadrotor_together_regulator_step_out_t, feedback.rotor_1), 1U, KIND_REAL,
     36U, 0U, 0U },
    { "feedback.rotor_2", offsetof(quadrotor_together_regulator_step_out_t, feedback.rotor_2), 1U, KIND_REAL,
     36U, 0U, 0U },
    { "feedback.rotor_3", offsetof(quadrotor_together_regulator_step_out_t, feedback.rotor_3), 1U, KIND_REAL,
     36U, 0U, 0U },
    { "feedback.rotor_4", offsetof(quadrotor_together_regulator_step_out_t, feedback.rotor_4), 1U, KIND_REAL,
     36U, 0U, 0U }
};

static const fields_t state_all = { state_fields, 6U };

static quadrotor_together_regulator_state_t state;
static const fields_t params_all = { params_fields, 22U };
static const quadrotor_together_regulator_params_t params_default = QUADROTOR_TOGETHER_REGULATOR_PARAMS_DEFAULT;

static quadrotor_together_regulator_params_t params;
static quadrotor_together_regulator_step_in_t step_in;
static quadrotor_together_regulator_step_out_t step_out;

static quadrotor_together_regulator_status_t call_init(void)
{
    return quadrotor_together_regulator_init(&state, &params);
}

static quadrotor_together_regulator_status_t call_step(void)
{
    return quadrotor_together_regulator_step(&state, &params, &step_in, &step_out);
}

#define ENTRIES 2U
#define INIT 0U

static const entry_t entries[ENTRIES] = {
    { "init",
NULL, { NULL, 0U },
NULL, 0U, { NULL, 0U },
      call_init },
    { "step",
&step_in, { step_in_fields, 14U },
&step_out, sizeof(step_out), { step_out_fields, 8U },
      call_step }
};

typedef struct
{
    quadrotor_together_regulator_status_t status;
    const char *name;
} status_name_t;

#define STATUSES 9U

static const status_name_t statuses[STATUSES] = {
    { QUADROTOR_TOGETHER_REGULATOR_OK, "OK" },
    { QUADROTOR_TOGETHER_REGULATOR_GATED, "GATED" },
    { QUADROTOR_TOGETHER_REGULATOR_CLAMPED, "CLAMPED" },
    { QUADROTOR_TOGETHER_REGULATOR_SKIPPED, "SKIPPED" },
    { QUADROTOR_TOGETHER_REGULATOR_RECOVERED, "RECOVERED" },
    { QUADROTOR_TOGETHER_REGULATOR_BAD_INPUT, "BAD_INPUT" },
    { QUADROTOR_TOGETHER_REGULATOR_BAD_PARAM, "BAD_PARAM" },
    { QUADROTOR_TOGETHER_REGULATOR_NOT_POSITIVE, "NOT_POSITIVE" },
    { QUADROTOR_TOGETHER_REGULATOR_OVERFLOW, "OVERFLOW" }
};

static unsigned long reached[ENTRIES][STATUSES];
static unsigned long calls = 0UL;
static unsigned long refused = 0UL;
static unsigned long lost = 0UL;

/* --- from bytes to values ----------------------------------------------------------------------------------------- */

/* The next bytes as a number; zero where there are none. */
static uint32_t take(bytes_t *from, uint32_t count)
{
    uint32_t value = 0U;

    for (uint32_t i = 0U; (i < count) && (from->left > 0U); i++)
    {
        value = (value << 8U) | (uint32_t)from->at[0];
        from->at = &from->at[1];
        from->left = from->left - 1U;
    }
    return value;
}

/* Between 0 and 1, both included. */
static real_t take_share(bytes_t *from)
{
    return (real_t)take(from, 2U) / 65535.0f;
}

static real_t clamp(real_t value, range_t range)
{
    real_t answer = value;

    if (answer < range.low)
    {
        answer = range.low;
    }
    if (answer > range.high)
    {
        answer = range.high;
    }
    return answer;
}

/* A value within a range: anywhere, at an end, zero, or of any magnitude. */
static real_t take_inside(bytes_t *from, range_t range)
{
    const uint32_t choice = take(from, 1U);
    real_t value = 0.0f;

    if ((choice & 7U) < 4U)
    {
        value = range.low + ((range.high - range.low) * take_share(from));
    }
    else if ((choice & 7U) < 7U)
    {
        const int shift = (int)take(from, 1U) / 2;

        value = ldexpf(fmaxf(fabsf(range.low), fabsf(range.high)) * (1.0f + take_share(from)), -shift);
        value = ((choice & 8U) != 0U) ? -value : value;
    }
    else if ((choice & 24U) == 8U)
    {
        value = range.low;
    }
    else if ((choice & 24U) == 16U)
    {
        value = range.high;
    }
    else
    {
        /* zero */
    }
    return clamp(value, range);
}

/* Any value at all: just outside a range, not a number, infinite, tiny, huge, or any bits. */
static real_t take_wild(bytes_t *from, range_t range)
{
    real_t value = 0.0f;
    unsigned char bits[sizeof(real_t)];

    switch (take(from, 1U) & 15U)
    {
        case 0U:
            value = nextafterf(range.low, -(real_t)INFINITY);
            break;
        case 1U:
            value = nextafterf(range.high, (real_t)INFINITY);
            break;
        case 2U:
        case 3U:
            value = (real_t)NAN;
            break;
        case 4U:
            value = (real_t)INFINITY;
            break;
        case 5U:
            value = -(real_t)INFINITY;
            break;
        case 6U:
            value = FLT_MAX;
            break;
        case 7U:
            value = -FLT_MAX;
            break;
        case 8U:
            value = nextafterf(0.0f, 1.0f);
            break;
        case 9U:
            value = -FLT_MIN;
            break;
        case 10U:
            value = -0.0f;
            break;
        default:
            for (size_t i = 0U; i < sizeof(real_t); i++)
            {
                bits[i] = (unsigned char)take(from, 1U);
            }
            (void)memcpy(&value, bits, sizeof(real_t));
            break;
    }
    return value;
}

static uint32_t take_count(bytes_t *from)
{
    const uint32_t choice = take(from, 1U);
    uint32_t value = choice & 3U;

    if (choice >= 240U)
    {
        value = take(from, 4U);
    }
    else if (choice >= 224U)
    {
        value = UINT32_MAX - (choice & 1U);
    }
    else
    {
        /* small */
    }
    return value;
}

static range_t range_of(const field_t *field, uint32_t i)
{
    return ranges[field->first + (i * field->stride)];
}

static void set_real(void *base, const field_t *field, uint32_t i, real_t value)
{
    unsigned char *const bytes = base;

    (void)memcpy(&bytes[field->offset + (i * sizeof(real_t))], &value, sizeof(real_t));
}

static real_t get_real(const void *base, const field_t *field, uint32_t i)
{
    const unsigned char *const bytes = base;
    real_t value = 0.0f;

    (void)memcpy(&value, &bytes[field->offset + (i * sizeof(real_t))], sizeof(real_t));
    return value;
}

/* A symmetric matrix whose elements beside the diagonal fit those on it: more often definite than any numbers are. */
static void take_symmetric(bytes_t *from, void *base, const field_t *field)
{
    uint32_t row_start = 0U;

    for (uint32_t i = 0U; i < field->order; i++)
    {
        set_real(base, field, row_start, take_inside(from, range_of(field, row_start)));
        row_start = row_start + (field->order - i);
    }
    row_start = 0U;
    for (uint32_t i = 0U; i < field->order; i++)
    {
        uint32_t other = row_start + (field->order - i);

        for (uint32_t j = i + 1U; j < field->order; j++)
        {
            const uint32_t k = row_start + (j - i);
            const int shift = (int)take(from, 1U) & 15;
            const real_t share = ldexpf((2.0f * take_share(from)) - 1.0f, -shift);
            const real_t size = sqrtf(get_real(base, field, row_start)) * sqrtf(get_real(base, field, other));

            set_real(base, field, k, clamp(share * size, range_of(field, k)));
            other = other + (field->order - j);
        }
        row_start = row_start + (field->order - i);
    }
}

/* Element `at` of all the real numbers of the memory, in their order; zero beyond the last. */
static real_t of_memory(uint32_t at)
{
    uint32_t first = 0U;
    real_t value = 0.0f;

    for (uint32_t k = 0U; k < state_all.count; k++)
    {
        const field_t *const field = &state_all.fields[k];

        if (field->kind == KIND_REAL)
        {
            if ((at >= first) && (at < (first + field->size)))
            {
                value = get_real(&state, field, at - first);
            }
            first = first + field->size;
        }
    }
    return value;
}

/* What the memory has, or nearly: a reading that agrees with it. */
static void take_from_memory(bytes_t *from, void *base, const field_t *field)
{
    const uint32_t choice = take(from, 1U);
    const uint32_t first = ((choice & 1U) != 0U) ? 0U : ((choice >> 1U) % 56U);

    for (uint32_t i = 0U; i < field->size; i++)
    {
        const int shift = (int)take(from, 1U) & 31;
        const real_t away = ldexpf(take_share(from) - 0.5f, -shift);

        set_real(base, field, i, clamp(of_memory(first + i) + away, range_of(field, i)));
    }
}

static void take_field(bytes_t *from, void *base, const field_t *field, bool wild)
{
    unsigned char *const bytes = base;
    const uint32_t choice = wild ? 0U : take(from, 1U);

    if ((field->order > 1U) && ((choice & 3U) != 0U))
    {
        take_symmetric(from, base, field);
    }
    else if ((base != (void *)&state) && (field->kind == KIND_REAL) && ((choice & 3U) == 3U))
    {
        take_from_memory(from, base, field);
    }
    else
    {
        for (uint32_t i = 0U; i < field->size; i++)
        {
            if (field->kind == KIND_REAL)
            {
                const range_t range = range_of(field, i);

                set_real(base, field, i, wild ? take_wild(from, range) : take_inside(from, range));
            }
            else if (field->kind == KIND_FLAG)
            {
                const bool flag = ((take(from, 1U) & 1U) != 0U);

                (void)memcpy(&bytes[field->offset + (i * sizeof(flag))], &flag, sizeof(flag));
            }
            else
            {
                const uint32_t count = take_count(from);

                (void)memcpy(&bytes[field->offset + (i * sizeof(count))], &count, sizeof(count));
            }
        }
    }
}

/* All fields of a struct: all plausible, one of them wild, or any of them. */
static void take_fields(bytes_t *from, void *base, fields_t all, bool plausible)
{
    const uint32_t choice = plausible ? 0U : take(from, 1U);
    const uint32_t one = (all.count > 0U) ? (take(from, 1U) % all.count) : 0U;

    for (uint32_t k = 0U; k < all.count; k++)
    {
        bool wild = false;

        if (choice >= 248U)
        {
            wild = ((take(from, 1U) & 1U) != 0U);
        }
        else if (choice >= 208U)
        {
            wild = (k == one);
        }
        else
        {
            /* plausible */
        }
        take_field(from, base, &all.fields[k], wild);
    }
}

static void take_params(bytes_t *from)
{
    const uint32_t choice = take(from, 1U);

    params = params_default;
    if (choice >= 128U)
    {
        take_fields(from, &params, params_all, choice < 224U);
    }
    else if (choice >= 64U)
    {
        /* the defaults, but for one field within its range */
        take_field(from, &params, &params_all.fields[take(from, 1U) % params_all.count], false);
    }
    else
    {
        /* the defaults */
    }
}

/* --- what must hold ----------------------------------------------------------------------------------------------- */

static void lose(const entry_t *entry, quadrotor_together_regulator_status_t status, const char *what,
     const char *field)
{
    lost = lost + 1UL;
    if (lost <= PRINTED)
    {
        (void)printf("lost in call %lu, %s, status %d: %s%s\n", calls, entry->name, (int)status, what, field);
    }
#ifdef WITH_LIBFUZZER
    (void)fflush(stdout);
    abort(); /* libFuzzer keeps the input */
#endif
}

static bool is_known(int32_t value)
{
    bool known = false;

    for (uint32_t i = 0U; i < STATUSES; i++)
    {
        known = known || (value == (int32_t)statuses[i].status);
    }
    return known;
}

/* The first field with a number outside its range (or not a number), or a status that nobody knows; else NULL. */
static const char *outside(const void *base, fields_t all)
{
    const unsigned char *const bytes = base;
    const char *found = NULL;

    for (uint32_t k = 0U; (k < all.count) && (found == NULL); k++)
    {
        const field_t *const field = &all.fields[k];

        for (uint32_t i = 0U; i < field->size; i++)
        {
            if (field->kind == KIND_REAL)
            {
                const real_t value = get_real(base, field, i);
                const range_t range = range_of(field, i);

                if (!((value >= range.low) && (value <= range.high)))
                {
                    found = field->name;
                }
            }
            else if (field->kind == KIND_STATUS)
            {
                int32_t value = 0;

                (void)memcpy(&value, &bytes[field->offset + (i * sizeof(value))], sizeof(value));
                found = is_known(value) ? found : field->name;
            }
            else
            {
                /* any value will do */
            }
        }
    }
    return found;
}

/* Write the fields of the memory back over zeros: padding has no value after a struct was copied. */
static void settle(void)
{
    static quadrotor_together_regulator_state_t clean;
    unsigned char *const to = (unsigned char *)&clean;
    const unsigned char *const from = (const unsigned char *)&state;

    (void)memset(&clean, 0, sizeof(clean));
    for (uint32_t k = 0U; k < state_all.count; k++)
    {
        const field_t *const field = &state_all.fields[k];
        size_t size = sizeof(uint32_t);

        if (field->kind == KIND_REAL)
        {
            size = sizeof(real_t);
        }
        else if (field->kind == KIND_FLAG)
        {
            size = sizeof(bool);
        }
        else
        {
            /* a count or a status */
        }
        (void)memcpy(&to[field->offset], &from[field->offset], field->size * size);
    }
    (void)memcpy(&state, &clean, sizeof(state));
}

static void count_status(uint32_t at, quadrotor_together_regulator_status_t status)
{
    calls = calls + 1UL;
    for (uint32_t i = 0U; i < STATUSES; i++)
    {
        if (status == statuses[i].status)
        {
            reached[at][i] = reached[at][i] + 1UL;
        }
    }
    if (!is_known((int32_t)status))
    {
        lose(&entries[at], status, "a status that nobody knows", "");
    }
}

static void call_and_judge(uint32_t at)
{
    static quadrotor_together_regulator_state_t before;
    static unsigned char out_before[sizeof(quadrotor_together_regulator_step_out_t)];
    const entry_t *const entry = &entries[at];
    quadrotor_together_regulator_status_t status = QUADROTOR_TOGETHER_REGULATOR_OK;

    (void)memcpy(&before, &state, sizeof(state));
    if (entry->out_size > 0U)
    {
        (void)memset(entry->out, 0xA5, entry->out_size);
        (void)memcpy(out_before, entry->out, entry->out_size);
    }
    status = entry->call();
    count_status(at, status);
    if (status < QUADROTOR_TOGETHER_REGULATOR_OK)
    {
        refused = refused + 1UL;
        if (memcmp(&before, &state, sizeof(state)) != 0)
        {
            lose(entry, status, "refused, but the memory changed", "");
            (void)memcpy(&state, &before, sizeof(state));
        }
        if ((entry->out_size > 0U) && (memcmp(out_before, entry->out, entry->out_size) != 0))
        {
            lose(entry, status, "refused, but the outputs changed", "");
        }
    }
    else
    {
        const char *const field = outside(&state, state_all);

        settle();
        if (field != NULL)
        {
            lose(entry, status, "outside its range: memory field ", field);
            (void)memcpy(&state, &before, sizeof(state));
        }
        if ((entry->out_size > 0U) && (outside(&params, params_all) == NULL))
        {
            const char *const output = outside(entry->out, entry->out_fields);

            if (output != NULL)
            {
                lose(entry, status, "outside its range, or not a number: output ", output);
            }
        }
    }
}

static void print_summary(void)
{
    for (uint32_t k = 0U; k < ENTRIES; k++)
    {
        (void)printf("%s:", entries[k].name);
        for (uint32_t i = 0U; i < STATUSES; i++)
        {
            if (reached[k][i] > 0UL)
            {
                (void)printf(" %s %lu", statuses[i].name, reached[k][i]);
            }
        }
        (void)printf("\n");
    }
    (void)printf("%lu calls, %lu refused, %lu lost\n", calls, refused, lost);
}

/* One input: where the memory starts, then calls until its bytes are used up. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes_t from = { data, size };

#ifdef WITH_LIBFUZZER
    static bool registered = false;

    if (!registered)
    {
        registered = true;
        (void)atexit(print_summary);
    }
#endif
    (void)memset(&state, 0, sizeof(state));
    take_params(&from);
    take_fields(&from, &state, state_all, true);
    if (take(&from, 1U) < 160U)
    {
        call_and_judge(INIT);
    }
    for (uint32_t k = 0U; (k < LONGEST_SEQUENCE) && (from.left > 0U); k++)
    {
        const uint32_t choice = take(&from, 1U);
        uint32_t at = choice % ENTRIES;

        if ((at == INIT) && (choice >= 64U))
        {
            at = 1U; /* init is rarer than the others */
        }
        if (take(&from, 1U) < 12U)
        {
            take_params(&from);
        }
        take_fields(&from, entries[at].in, entries[at].in_fields, false);
        call_and_judge(at);
    }
    return 0;
}

/* --- the program of its own --------------------------------------------------------------------------------------- */

#ifndef WITH_LIBFUZZER
static uint8_t input[LONGEST_INPUT];

static uint64_t next_random(uint64_t *seed)
{
    *seed = *seed ^ (*seed << 13U);
    *seed = *seed ^ (*seed >> 7U);
    *seed = *seed ^ (*seed << 17U);
    return *seed;
}

static void call_at_random(unsigned long wanted, uint64_t seed)
{
    uint64_t random = (seed * 2862933555777941757U) + 3037000493U;

    while (calls < wanted)
    {
        const size_t size = 256U + (size_t)(next_random(&random) % (LONGEST_INPUT - 256U));
        uint64_t bits = 0U;

        for (size_t i = 0U; i < size; i++)
        {
            bits = ((i & 7U) == 0U) ? next_random(&random) : (bits >> 8U);
            input[i] = (uint8_t)(bits & 255U);
        }
        (void)LLVMFuzzerTestOneInput(input, size);
    }
}

static int replay(const char *path)
{
    FILE *const file = fopen(path, "rb");
    int failed = 1;

    if (file != NULL)
    {
        const size_t size = fread(input, 1U, LONGEST_INPUT, file);

        (void)LLVMFuzzerTestOneInput(input, size);
        failed = fclose(file);
    }
    else
    {
        (void)printf("%s cannot be read\n", path);
    }
    return failed;
}

int main(int argc, char *argv[])
{
    char *end = NULL;
    const unsigned long wanted = (argc > 1) ? strtoul(argv[1], &end, 10) : 1000000UL;
    int failed = 0;

    if ((argc > 1) && (*end != '\0'))
    {
        for (int k = 1; k < argc; k++)
        {
            failed = failed + replay(argv[k]);
        }
    }
    else
    {
        call_at_random(wanted, (argc > 2) ? (uint64_t)strtoul(argv[2], NULL, 10) : 1U);
    }
    print_summary();
    return ((failed == 0) && (lost == 0UL)) ? 0 : 1;
}
#endif
