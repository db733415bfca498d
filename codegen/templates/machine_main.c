/* Start-up, semihosting and a counter of instructions for the emulated machines: QEMU's mps2-an386, mps2-an500, virt. */
#include "machine_main.h"

#define PAINT 0xDEADBEEFu
#define OWN 256u /* words that this program itself may use: painted anew before each call */
#define BUFFER 32768u

extern uint32_t stack_low, stack_high, data_source, data_start, data_end, bss_start, bss_end;

static uint8_t incoming[BUFFER], outgoing[BUFFER];
static uint32_t incoming_at, incoming_size, outgoing_size;
static int32_t calls_file, answers_file;
static uint32_t *unpainted;
void start(void);

/* ---- the machine -------------------------------------------------------------------------------------------- */

#if defined(__arm__)

#define TIMER ((volatile uint32_t *)0x40000000u) /* CMSDK timer: counts down at 25 MHz of emulated time */

static int32_t host(uint32_t operation, const void *block)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return (int32_t)r0;
}

static inline uint32_t ticks(void)
{
    return 0xFFFFFFFFu - TIMER[1];
}

static void start_counter(void)
{
    TIMER[2] = 0xFFFFFFFFu;
    TIMER[1] = 0xFFFFFFFFu;
    TIMER[0] = 1u;
}

__asm__(".text\n.thumb\n.global shortest\n.thumb_func\nshortest:\n    bx lr\n");

/* The FPU must be on before any code that might save its registers: so this function has none. */
__asm__(".section .start,\"ax\",%progbits\n.thumb\n.global reset\n.thumb_func\nreset:\n"
        "    ldr r0, =0xE000ED88\n    ldr r1, [r0]\n    orr r1, r1, #0xF00000\n    str r1, [r0]\n    dsb\n    isb\n"
        "    bl start\n    .ltorg\n.text\n");

static void fault(void);
extern void reset(void);
__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    (void (*)(void)) & stack_high, reset, fault, fault, fault, fault, fault, 0, 0, 0, 0, fault, fault, 0, fault, fault};

#else

static int32_t host(uint32_t operation, const void *block)
{
    register uint32_t a0 __asm__("a0") = operation;
    register const void *a1 __asm__("a1") = block;
    __asm__ volatile(".option push\n.option norvc\n.balign 16\n"
                     "slli zero, zero, 0x1f\nebreak\nsrai zero, zero, 7\n.option pop"
                     : "+r"(a0)
                     : "r"(a1)
                     : "memory");
    return (int32_t)a0;
}

static inline uint32_t ticks(void)
{
    uint32_t count;
    __asm__ volatile(".option push\n.option arch, +zicsr\ncsrr %0, minstret\n.option pop" : "=r"(count) : : "memory");
    return count;
}

static void start_counter(void)
{
}

__asm__(".text\n.balign 4\n.global shortest\nshortest:\n    ret\n");

/* Stack, thread pointer (the C library's errno), traps, and the FPU (mstatus.FS). */
__asm__(".section .start,\"ax\",@progbits\n.global reset\nreset:\n.option push\n.option norelax\n.option arch, +zicsr\n"
        "    la sp, stack_high\n    la tp, thread_start\n    la t0, trap\n    csrw mtvec, t0\n"
        "    li t0, 0x6000\n    csrs mstatus, t0\n    csrwi fcsr, 0\n    call start\n"
        "    .balign 4\ntrap:\n    call fault\n.option pop\n.text\n");

#endif

static inline uint32_t *stack_pointer(void)
{
    uint32_t *pointer;
#if defined(__arm__)
    __asm__ volatile("mov %0, sp" : "=r"(pointer));
#else
    __asm__ volatile("mv %0, sp" : "=r"(pointer));
#endif
    return pointer;
}

static void leave(uint32_t code)
{
    uint32_t block[2];
    block[0] = 0x20026u; /* application exit */
    block[1] = code;
    host(0x20u, block);
    for (;;)
    {
    }
}

__attribute__((used)) void fault(void)
{
    leave(70u);
}

/* ---- files of the host -------------------------------------------------------------------------------------- */

static int32_t open_file(const char *name, uint32_t length, uint32_t mode)
{
    uint32_t block[3];
    block[0] = (uint32_t)(uintptr_t)name;
    block[1] = mode;
    block[2] = length;
    return host(0x01u, block);
}

static void flush(void)
{
    uint32_t block[3];
    block[0] = (uint32_t)answers_file;
    block[1] = (uint32_t)(uintptr_t)outgoing;
    block[2] = outgoing_size;
    if ((outgoing_size > 0u) && (host(0x05u, block) != 0))
    {
        leave(71u);
    }
    outgoing_size = 0u;
}

int read_calls(void *to, uint32_t size)
{
    uint8_t *bytes = to;
    uint32_t i;
    for (i = 0u; i < size; ++i)
    {
        if (incoming_at == incoming_size)
        {
            uint32_t block[3];
            block[0] = (uint32_t)calls_file;
            block[1] = (uint32_t)(uintptr_t)incoming;
            block[2] = BUFFER;
            incoming_size = BUFFER - (uint32_t)host(0x06u, block);
            incoming_at = 0u;
            if (incoming_size == 0u)
            {
                return 0;
            }
        }
        bytes[i] = incoming[incoming_at++];
    }
    return 1;
}

void write_answers(const void *from, uint32_t size)
{
    const uint8_t *bytes = from;
    uint32_t i;
    for (i = 0u; i < size; ++i)
    {
        if (outgoing_size == BUFFER)
        {
            flush();
        }
        outgoing[outgoing_size++] = bytes[i];
    }
}

/* ---- measured calls ----------------------------------------------------------------------------------------- */

__attribute__((noinline)) measured_t measured_call(entry_t function, void *first, void *second, void *third,
                                                   void *fourth)
{
    measured_t answer;
    volatile uint32_t *place = unpainted;
    volatile uint32_t *const pointer = stack_pointer();
    uint32_t before, after;
    /* What ran since the last call, such as reading the next ones, wrote there too, deeper perhaps than that call. */
    if (((uint32_t)(&stack_high - &stack_low) > OWN) && (place > &stack_high - OWN))
    {
        place = &stack_high - OWN;
    }
    while (place < pointer)
    {
        *place++ = PAINT;
    }
    before = ticks();
    answer.status = function(first, second, third, fourth);
    after = ticks();
    place = &stack_low;
    while ((place < pointer) && (*place == PAINT))
    {
        ++place;
    }
    unpainted = (uint32_t *)place;
    if (place == &stack_low)
    {
        leave(72u);
    }
    answer.ticks = after - before;
    answer.stack = (uint32_t)((uintptr_t)pointer - (uintptr_t)place);
    return answer;
}

__attribute__((noinline)) static void run(void)
{
    start_counter();
    unpainted = &stack_low;
    calls_file = open_file("calls.bin", 9u, 1u);
    answers_file = open_file("answers.bin", 11u, 5u);
    if ((calls_file < 0) || (answers_file < 0))
    {
        leave(73u);
    }
    run_calls();
    flush();
    leave(0u);
}

__attribute__((used, noreturn)) void start(void)
{
    volatile uint32_t *from = &data_source;
    volatile uint32_t *to;
    for (to = &data_start; to < &data_end; ++to)
    {
        *to = *from++;
    }
    for (to = &bss_start; to < &bss_end; ++to)
    {
        *to = 0u;
    }
    run();
    for (;;)
    {
    }
}
