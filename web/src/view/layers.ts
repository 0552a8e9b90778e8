// What three draws together.

export const kCloudLayer = 1; // of what is drawn into the backdrop
