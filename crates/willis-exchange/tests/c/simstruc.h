/* A stand-in for Simulink's header of the same name: what the exported S-function uses, so that it can be compiled
   and called where there is no Simulink. Written from the documented meaning of the macros. */
#ifndef SIMSTRUC_H
#define SIMSTRUC_H

typedef double real_T;
typedef int int_T;

typedef struct {
    int_T inputs, outputs, width_in[8], width_out[8];
    real_T *in[8], *out[8];
} SimStruct;

#define INHERITED_SAMPLE_TIME (-1.0)
#define SS_OPTION_EXCEPTION_FREE_CODE 1
#define ssSetNumSFcnParams(S, n) ((void)(S))
#define ssGetNumSFcnParams(S) (0)
#define ssGetSFcnParamsCount(S) (0)
#define ssSetNumContStates(S, n) ((void)(S))
#define ssSetNumDiscStates(S, n) ((void)(S))
#define ssSetNumInputPorts(S, n) ((S)->inputs = (n), 1)
#define ssSetNumOutputPorts(S, n) ((S)->outputs = (n), 1)
#define ssSetInputPortWidth(S, k, n) ((S)->width_in[k] = (n))
#define ssSetOutputPortWidth(S, k, n) ((S)->width_out[k] = (n))
#define ssSetInputPortRequiredContiguous(S, k, is) ((void)(S))
#define ssSetInputPortDirectFeedThrough(S, k, is) ((void)(S))
#define ssGetInputPortSignal(S, k) ((const void *)(S)->in[k])
#define ssGetOutputPortRealSignal(S, k) ((S)->out[k])
#define ssSetNumSampleTimes(S, n) ((void)(S))
#define ssSetSampleTime(S, k, t) ((void)(S))
#define ssSetOffsetTime(S, k, t) ((void)(S))
#define ssSetOptions(S, o) ((void)(S))

#endif
