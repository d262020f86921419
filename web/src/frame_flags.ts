import { kFrameFinal, kFrameFull, kFrameLossless, kFrameMoving, type FrameHeader } from './protocol/messages.gen';

type Flagged = Pick<FrameHeader, 'flags'>;

export const isMoving = (header: Flagged): boolean => (header.flags & kFrameMoving) !== 0;
export const isLossless = (header: Flagged): boolean => (header.flags & kFrameLossless) !== 0;
export const isFinal = (header: Flagged): boolean => (header.flags & kFrameFinal) !== 0;
export const isFull = (header: Flagged): boolean => (header.flags & kFrameFull) !== 0;
